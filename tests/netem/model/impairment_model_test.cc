#include "netem/model/impairment_model.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
#include "tests/netem/model/impairment_builders.h"
#include "tests/netem/model/impairment_generators.h"
#include "tests/netem/model/outcomes.h"

namespace palp::netem {
namespace {

using std::chrono::milliseconds;

struct Moments {
  double mean{};    ///< [ms]
  double stddev{};  ///< [ms]
  double lag1{};    ///< [1]
};

Moments delay_moments(const std::vector<PacketOutcome>& outcomes) {
  const auto n = static_cast<double>(outcomes.size());
  const auto delay = [&](std::size_t i) { return seconds(outcomes[i].copies[0].delay) * 1e3; };
  Moments moments;
  for (std::size_t i = 0; i < outcomes.size(); ++i) moments.mean += delay(i) / n;
  double variance = 0;
  double product = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const double off = delay(i) - moments.mean;
    variance += off * off / n;
    if (i > 0) product += off * (delay(i - 1) - moments.mean) / n;
  }
  moments.stddev = std::sqrt(variance);
  moments.lag1 = product / variance;
  return moments;
}

bool same(const PacketOutcome& left, const PacketOutcome& right) {
  bool equal = left.count == right.count;
  for (std::size_t copy = 0; copy < left.count && equal; ++copy) {
    equal = left.copies[copy].verdict == right.copies[copy].verdict &&
            left.copies[copy].delay == right.copies[copy].delay &&
            left.copies[copy].release == right.copies[copy].release;
  }
  return equal;
}

constexpr const char* kEverything =
    "delay 20ms 6ms distribution normal correlation-time 10ms loss 3% loss burst 2/s 20ms "
    "loss gilbert-time 300ms 15ms 80% 1% duplicate 10% blackout 200ms 50ms order free";

TEST(ImpairmentModelTest, SameSeedGivesTheSameOutcomes) {
  const auto once = outcomes_of(impaired(kEverything), 5000);
  const auto again = outcomes_of(impaired(kEverything), 5000);
  EXPECT_TRUE(std::equal(once.begin(), once.end(), again.begin(), same));
}

TEST(ImpairmentModelTest, AnotherSeedOrDirectionGivesOthers) {
  const auto share_of_same = [](const std::vector<PacketOutcome>& left,
                                const std::vector<PacketOutcome>& right) {
    double equal = 0;
    for (std::size_t i = 0; i < left.size(); ++i) equal += same(left[i], right[i]) ? 1 : 0;
    return equal / static_cast<double>(left.size());
  };
  const auto words = impaired("delay 20ms 6ms loss 5% order free");
  const auto up = outcomes_of(words, 2000);
  EXPECT_LT(share_of_same(up, outcomes_of(words, 2000, milliseconds{1}, 2)), 0.02);
  EXPECT_LT(share_of_same(up, outcomes_of(words, 2000, milliseconds{1}, 1, Direction::Down)), 0.02);
}

/// One stage of an impairment put back to nothing.
Impairment without(const Impairment& impairment, int stage) {
  Impairment less = impairment;
  if (stage == 0) less.delay = {};
  if (stage == 1) less.loss = {};
  if (stage == 2) less.burst = {};
  if (stage == 3) less.gilbert = {};
  if (stage == 4) less.duplicate = {};
  if (stage == 5) less.blackouts.clear();
  if (stage == 6) less.state.reset();
  if (stage == 7) less.gemodel.reset();
  if (stage == 8) less.corrupt = {};
  if (stage == 9) less.reorder = {};
  if (stage == 10) less.stall = {};
  return less;
}

RC_GTEST_PROP(ImpairmentModelTest, SwitchingAStageOffLeavesTheOtherDrawsAlone, ()) {
  Impairment all = make_impairment(milliseconds{200});
  // What one datagram leaves to the next, room in a queue and places in the order, is not a draw.
  all.order = Order::Netem;
  all.rate = {};
  all.queue = {};
  all.slot = {};
  all.limit = 0;
  const int off = *rc::gen::inRange(0, 11);
  const std::uint64_t seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto with = outcomes_of(all, 300, milliseconds{1}, seed);
  const auto less = outcomes_of(without(all, off), 300, milliseconds{1}, seed);
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (off != 4) RC_ASSERT(with[i].count == less[i].count);
    for (std::size_t copy = 0; copy < std::min(with[i].count, less[i].count); ++copy) {
      const CopyOutcome& before = with[i].copies[copy];
      const CopyOutcome& after = less[i].copies[copy];
      const bool both = before.verdict == Verdict::Delivered && after.verdict == Verdict::Delivered;
      // What got through still does; with the stage a loss can only be added.
      if (before.verdict == Verdict::Delivered) RC_ASSERT(both);
      if (off != 0 && both) RC_ASSERT(before.delay == after.delay);
      if (off != 8) RC_ASSERT(before.flipped_bit == after.flipped_bit);
      if (off != 9) RC_ASSERT(before.immediate == after.immediate || !both);
      const bool harmless = off == 0 || off == 4 || off == 9 || off == 10;
      if (harmless) RC_ASSERT(before.verdict == after.verdict);
    }
  }
}

TEST(ImpairmentModelTest, StagesDrawIndependently) {
  double both = 0;
  double delay = 0;  // [ms], of what is neither lost nor duplicated
  double count = 0;
  for (const PacketOutcome& outcome :
       outcomes_of(impaired("delay 50ms 10ms loss 50% duplicate 50%"), 40'000)) {
    if (outcome.count == 2 && lost(outcome)) both += 1;
    if (outcome.count == 1 && !lost(outcome)) {
      delay += seconds(outcome.copies[0].delay) * 1e3;
      count += 1;
    }
  }
  EXPECT_NEAR(both / 40'000, 0.25, 4 * std::sqrt(0.25 * 0.75 / 40'000));
  EXPECT_NEAR(delay / count, 50, 4 * 10 / std::sqrt(3 * count));
}

class ImpairmentModelLossTest : public ::testing::TestWithParam<std::tuple<double, std::uint64_t>> {
};

TEST_P(ImpairmentModelLossTest, LosesTheShareThatWasAsked) {
  const auto [p, seed] = GetParam();
  Impairment impairment;
  impairment.loss.share = p;
  constexpr std::size_t kCount = 40'000;
  const double se = std::sqrt(p * (1 - p) / kCount);
  EXPECT_NEAR(loss_share(outcomes_of(impairment, kCount, milliseconds{1}, seed)), p, 4 * se);
}

INSTANTIATE_TEST_SUITE_P(Shares,
                         ImpairmentModelLossTest,
                         ::testing::Combine(::testing::Values(0.0, 0.001, 0.05, 0.3, 0.9, 1.0),
                                            ::testing::Values(1, 2, 77)));

TEST(ImpairmentModelTest, CorrelatedLossesKeepTheirShareAndCorrelateAsAsked) {
  for (const double p : {0.01, 0.1, 0.5}) {
    for (const double c : {0.25, 0.5, 0.9}) {
      Impairment impairment;
      impairment.loss = {p, c};
      constexpr std::size_t kCount = 400'000;
      const auto outcomes = outcomes_of(impairment, kCount);
      // A mean of a chain has (1 + c) / (1 - c) times the variance of independent ones.
      const double error = std::sqrt(p * (1 - p) / kCount * (1 + c) / (1 - c));
      EXPECT_NEAR(loss_share(outcomes), p, 4 * error) << p << ' ' << c;
      double losses = 0;
      double again = 0;
      for (std::size_t i = 0; i + 1 < kCount; ++i) {
        if (!lost(outcomes[i])) continue;
        losses += 1;
        again += lost(outcomes[i + 1]) ? 1 : 0;
      }
      const double expected = p + c * (1 - p);
      EXPECT_NEAR(again / losses, expected, 4 * std::sqrt(expected * (1 - expected) / losses));
    }
  }
}

/// Lengths of the runs of losses [ms]; a run that touches an end does not count.
std::vector<double> loss_runs_ms(const std::vector<PacketOutcome>& outcomes, Duration period) {
  std::vector<double> runs;
  std::size_t length = 0;
  for (const PacketOutcome& outcome : outcomes) {
    if (lost(outcome)) {
      ++length;
    } else {
      if (length > 0) runs.push_back(static_cast<double>(length) * seconds(period) * 1e3);
      length = 0;
    }
  }
  return runs;
}

TEST(ImpairmentModelTest, PacketModelsOfLossGoAsTheirChainsSay) {
  // Gilbert-Elliott: bad for p / (p + r) of the time. 4-state with p13, p31 alone: the same.
  for (const auto& [words, share, run] : {std::tuple{"loss gemodel 1% 20%", 1.0 / 21, 5.0},
                                          {"loss state 1% 30%", 1.0 / 31, 1 / 0.3}}) {
    const auto outcomes = outcomes_of(impaired(words), 400'000);
    const double c = 1 - 1 / run;
    const double error = std::sqrt(share * (1 - share) / 400'000 * (1 + c) / (1 - c));
    EXPECT_NEAR(loss_share(outcomes), share, 4 * error) << words;
    const auto runs = loss_runs_ms(outcomes, milliseconds{1});
    double mean = 0;
    for (const double one : runs) mean += one / static_cast<double>(runs.size());
    EXPECT_NEAR(mean, run, 4 * run * std::sqrt(c / static_cast<double>(runs.size()))) << words;
  }
}

TEST(ImpairmentModelTest, BurstsLastEquallyLongAtAnySendingRate) {
  const auto words = impaired("loss burst 2/s 40ms");
  for (const Duration period : {Duration{4'000'000}, Duration{1'000'000}, Duration{250'000}}) {
    const auto outcomes =
        outcomes_of(words, static_cast<std::size_t>(std::chrono::minutes{2} / period), period);
    const auto runs = loss_runs_ms(outcomes, period);
    // A minute has 2/s * 60 s less what the bursts themselves take: 120 / (1 + 2 * 0.04).
    EXPECT_NEAR(static_cast<double>(runs.size()), 222, 4 * std::sqrt(222.0));
    for (const double run : runs) {
      // Two bursts may touch, with nothing delivered between them.
      EXPECT_NEAR(std::remainder(run, 40), 0, 1e-9) << "period " << seconds(period);
    }
  }
}

TEST(ImpairmentModelTest, BurstStartsMoreSeldomInAGapThanTheGapIsLong) {
  // After one second of silence rate * dt would be 2: it saturates as a Poisson process does.
  const auto outcomes =
      outcomes_of(impaired("loss burst 2/s 1us"), 20'000, std::chrono::seconds{1});
  const double expected = 1 - std::exp(-2.0);
  EXPECT_NEAR(loss_share(outcomes), expected, 4 * std::sqrt(expected * (1 - expected) / 20'000));
}

TEST(ImpairmentModelTest, NoBurstStartsInTheTimeThatABurstTook) {
  // Packets 1 s apart. A burst takes its first one and the next; 0.5 s of the gap to the third are
  // free of it, so that one starts another with 1 - exp(-0.25), later ones with 1 - exp(-0.5).
  const auto outcomes =
      outcomes_of(impaired("loss burst 0.5/s 1500ms"), 40'000, std::chrono::seconds{1});
  const double delivered = std::exp(-0.25) / (1 - std::exp(-0.5));  // per burst
  EXPECT_NEAR(loss_share(outcomes), 2 / (2 + delivered), 0.012);    // 4 SE of 10,000 cycles
}

TEST(ImpairmentModelTest, GilbertStaysLastEquallyLongAtAnySendingRate) {
  const auto words = impaired("loss gilbert-time 180ms 20ms");
  for (const Duration period : {Duration{4'000'000}, Duration{250'000}}) {
    const auto count = static_cast<std::size_t>(std::chrono::minutes{4} / period);
    const auto outcomes = outcomes_of(words, count, period);
    // Cycles of 200 ms: 1200 of them; the bad share of each has a relative spread of about
    // sqrt(2) * 0.9, so its mean one of 0.9 * sqrt(2 / 1200).
    EXPECT_NEAR(loss_share(outcomes), 0.1, 4 * 0.1 * 0.9 * std::sqrt(2.0 / 1200));
    const auto runs = loss_runs_ms(outcomes, period);
    double mean = 0;
    for (const double run : runs) mean += run / static_cast<double>(runs.size());
    // Seen through samples a run of exponential length is a geometric number of periods:
    // T / (1 - exp(-T / 20 ms)), joined over good stays that no sample saw.
    const double step = seconds(period) * 1e3;
    EXPECT_NEAR(
        mean, step / (1 - std::exp(-step / 20)), 4 * 20 / std::sqrt(runs.size()) + 0.04 * step);
  }
}

TEST(ImpairmentModelTest, GilbertLosesInBothStatesWithTheirOwnShares) {
  const auto outcomes = outcomes_of(impaired("loss gilbert-time 20ms 20ms 60% 10%"), 200'000);
  // 5000 cycles of 40 ms; the state's share has an error of 0.25 * sqrt(2 * 2 / 5000) at most.
  EXPECT_NEAR(loss_share(outcomes), 0.35, 4 * 0.5 * 0.25 * std::sqrt(4.0 / 5000));
}

TEST(ImpairmentModelTest, GilbertStaysOfTheSameIndexAreTheSameAtAnySendingRate) {
  const auto words = impaired("loss gilbert-time 50ms 50ms");
  const auto coarse = outcomes_of(words, 10'000, milliseconds{1});
  const auto fine = outcomes_of(words, 40'000, Duration{250'000});
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    ASSERT_EQ(lost(coarse[i]), lost(fine[4 * i])) << i;
  }
}

TEST(ImpairmentModelTest, GilbertIsJudgedAfterAnyGapWithBoundedWork) {
  ImpairmentModel sequence{
      impaired("loss gilbert-time 100us 100us"), 3, Direction::Up, TimePoint{}};
  int losses = 0;
  for (int i = 0; i < 2000; ++i) {
    const TimePoint at{std::chrono::hours{i}};
    losses += lost(outcome_of(sequence.next({.at = at, .length = 1, .room = 1}))) ? 1 : 0;
  }
  EXPECT_NEAR(losses, 1000, 4 * std::sqrt(500.0));
}

TEST(ImpairmentModelTest, BlackoutTakesExactlyItsWindow) {
  const auto outcomes = outcomes_of(impaired("blackout 12ms 3ms duplicate 100%"), 20);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Verdict expected = i >= 12 && i < 15 ? Verdict::Blackout : Verdict::Delivered;
    EXPECT_EQ(outcomes[i].copies[0].verdict, expected) << i;
    EXPECT_EQ(outcomes[i].copies[1].verdict, expected) << i;
  }
}

TEST(ImpairmentModelTest, DuplicatesTheAskedShareWithDelaysOfTheirOwn) {
  const auto outcomes = outcomes_of(impaired("delay 20ms 5ms duplicate 20% order free"), 20'000);
  double copies = 0;
  double equal = 0;
  for (const PacketOutcome& outcome : outcomes) {
    if (outcome.count == 1) continue;
    copies += 1;
    if (outcome.copies[0].delay == outcome.copies[1].delay) equal += 1;
  }
  EXPECT_NEAR(copies, 4000, 4 * std::sqrt(20'000 * 0.2 * 0.8));
  EXPECT_EQ(equal, 0);
}

TEST(ImpairmentModelTest, RefusesWhatFindsNoRoom) {
  ImpairmentModel sequence{impaired("duplicate 100%"), 1, Direction::Up, TimePoint{}};
  const auto verdicts = [&](std::size_t length, std::size_t room) {
    const PacketOutcome outcome =
        outcome_of(sequence.next({.at = TimePoint{}, .length = length, .room = room}));
    return std::pair{outcome.copies[0].verdict, outcome.copies[1].verdict};
  };
  EXPECT_EQ(verdicts(1200, 2), (std::pair{Verdict::Delivered, Verdict::Delivered}));
  EXPECT_EQ(verdicts(1200, 1), (std::pair{Verdict::Delivered, Verdict::OverLimit}));
  EXPECT_EQ(verdicts(1200, 0), (std::pair{Verdict::OverLimit, Verdict::OverLimit}));
}

TEST(ImpairmentModelTest, ConstantDelayIsExact) {
  for (const PacketOutcome& outcome : outcomes_of(impaired("delay 12.345678ms"), 100)) {
    EXPECT_EQ(outcome.copies[0].delay, Duration{12'345'678});
  }
}

TEST(ImpairmentModelTest, DelaysHaveTheAskedMeanAndSpread) {
  constexpr double kCount = 100'000;
  // Standard errors of the mean, sd / sqrt(n), and of the spread, sd * sqrt((k - 1) / 4n) with the
  // kurtosis k = 3 (normal) or 1.8 (uniform).
  const auto normal =
      delay_moments(outcomes_of(impaired("delay 50ms 10ms distribution normal"), 100'000));
  EXPECT_NEAR(normal.mean, 50, 4 * 10 / std::sqrt(kCount));
  EXPECT_NEAR(normal.stddev, 10, 4 * 10 * std::sqrt(2 / (4 * kCount)));
  EXPECT_NEAR(normal.lag1, 0, 4 / std::sqrt(kCount));
  const auto uniform = delay_moments(outcomes_of(impaired("delay 50ms 10ms"), 100'000));
  const double spread = 10 / std::sqrt(3.0);
  EXPECT_NEAR(uniform.mean, 50, 4 * spread / std::sqrt(kCount));
  EXPECT_NEAR(uniform.stddev, spread, 4 * spread * std::sqrt(0.8 / (4 * kCount)));
  EXPECT_NEAR(uniform.lag1, 0, 4 / std::sqrt(kCount));
}

TEST(ImpairmentModelTest, EveryShapeHasTheAskedMeanAndSpread) {
  for (const char* shape : {"pareto", "paretonormal", "gamma", "lognormal"}) {
    const std::string words = std::string{"delay 50ms 10ms order netem distribution "} + shape;
    const auto moments = delay_moments(outcomes_of(impaired(words), 200'000));
    EXPECT_NEAR(moments.mean, 50, 4 * 10 / std::sqrt(200'000)) << shape;
    // Heavy tails spread their own spread: kurtosis below 20.
    EXPECT_NEAR(moments.stddev, 10, 4 * 10 * std::sqrt(19 / (4 * 200'000.0))) << shape;
  }
}

TEST(ImpairmentModelTest, UniformDelaysStayInsideTheirInterval) {
  for (const char* words : {"delay 50ms 10ms", "delay 50ms 10ms 90%"}) {
    for (const PacketOutcome& outcome : outcomes_of(impaired(words), 20'000)) {
      EXPECT_GE(outcome.copies[0].delay, milliseconds{40});
      EXPECT_LE(outcome.copies[0].delay, milliseconds{60});
    }
  }
}

TEST(ImpairmentModelTest, SuccessiveDelaysCorrelateAsAsked) {
  for (const char* shape : {"uniform", "normal", "pareto", "paretonormal", "gamma", "lognormal"}) {
    for (const int percent : {0, 25, 50, 90}) {
      const std::string words =
          "delay 50ms 5ms " + std::to_string(percent) + "% distribution " + shape;
      const auto moments = delay_moments(outcomes_of(impaired(words), 200'000));
      EXPECT_NEAR(moments.lag1, percent / 100.0, 0.02) << words;
      EXPECT_NEAR(moments.mean, 50, 0.3) << words;
    }
  }
}

TEST(ImpairmentModelTest, CorrelationInTimeIsTheSameAtAnySendingRate) {
  const auto words = impaired("delay 50ms 5ms distribution normal correlation-time 40ms");
  for (const Duration period : {Duration{4'000'000}, Duration{250'000}}) {
    const auto moments = delay_moments(outcomes_of(words, 400'000, period));
    EXPECT_NEAR(moments.lag1, std::exp(-seconds(period) / 0.04), 0.02);
  }
}

TEST(ImpairmentModelTest, DelaysAreLiftedToTheFloorAndNeverNegative) {
  // 0.2 T at sigma = 0.8 T: one standard deviation below the mean, 15.87 % of all.
  const auto outcomes =
      outcomes_of(impaired("delay 10ms 8ms distribution normal floor 20%"), 50'000);
  double floored = 0;
  for (const PacketOutcome& outcome : outcomes) {
    EXPECT_GE(outcome.copies[0].delay, milliseconds{2});
    if (outcome.copies[0].floored) {
      EXPECT_EQ(outcome.copies[0].delay, milliseconds{2});
      floored += 1;
    }
  }
  const double expected = normal_cdf(-1);
  EXPECT_NEAR(floored / 50'000, expected, 4 * std::sqrt(expected * (1 - expected) / 50'000));
  for (const PacketOutcome& outcome : outcomes_of(impaired("delay 1ms 8ms order free"), 5000)) {
    EXPECT_GE(outcome.copies[0].delay, Duration{});
  }
}

TEST(ImpairmentModelTest, KeptOrderReleasesNothingBeforeItsPredecessor) {
  TimePoint last{};
  for (const PacketOutcome& outcome :
       outcomes_of(impaired("delay 50ms 20ms duplicate 10% loss 5%"), 20'000)) {
    for (std::size_t copy = 0; copy < outcome.count; ++copy) {
      if (outcome.copies[copy].verdict != Verdict::Delivered) continue;
      EXPECT_GE(outcome.copies[copy].release, last);
      last = outcome.copies[copy].release;
    }
  }
}

TEST(ImpairmentModelTest, ArrivalsThatGoBackInTimeCountAsTheNewest) {
  ImpairmentModel sequence{impaired("delay 10ms order free"), 1, Direction::Up, TimePoint{}};
  const TimePoint start{milliseconds{100}};
  (void)sequence.next({.at = start, .length = 1, .room = 9});
  const PacketOutcome outcome =
      outcome_of(sequence.next({.at = start - milliseconds{1}, .length = 1, .room = 9}));
  EXPECT_EQ(outcome.copies[0].release, start + milliseconds{10});
}

}  // namespace
}  // namespace palp::netem
