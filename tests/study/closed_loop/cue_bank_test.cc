#include "study/closed_loop/cue_bank.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr Task kTwo{};
constexpr Task kBias{.two_sided = true};
constexpr Task kYesNo{.two_sided = true, .yes_no = true};

/// A coupling that shows `gain` of a difference, shifted by `offset`.
CueBank made(double gain, double offset, const Task& task, double noise = 0) {
  CueBank bank{.task = task};
  for (int i = task.two_sided && !task.yes_no ? -12 : 0; i <= 12; ++i) {
    bank.levels.push_back(0.1 * i);
    bank.differences.emplace_back();
    for (std::uint64_t k = 0; k < 40; ++k) {
      const double random = noise * random_normal(1, static_cast<std::uint64_t>(i + 20), k);
      bank.differences.back().push_back(
          CueBank::Differences(task.yes_no ? 1 : static_cast<std::size_t>(task.intervals - 1),
                               offset + gain * bank.levels.back() + random));
    }
  }
  return bank;
}

TEST(CueBankTest, BankAndClosedFormAgreeWhereFeltFollowsTrue) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  for (const double gain : {0.4, 1.0}) {
    const CueBank bank = made(gain, 0, kTwo);
    const FeltLine line = line_of(bank);
    EXPECT_NEAR(line.gain, gain, 1e-9);
    EXPECT_NEAR(closed_form(line, kTwo, judgement, 3).jnd, std::log1p(0.15) / gain, 1e-9);
    EXPECT_NEAR(banked(bank, judgement, 3).jnd, std::log1p(0.15) / gain, 0.01);
  }
}

TEST(CueBankTest, AShiftIsABias) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const CueBank bank = made(0.5, -0.2, kBias);
  EXPECT_NEAR(closed_form(line_of(bank), kBias, judgement, 3).pse, 0.4, 1e-9);
  EXPECT_NEAR(banked(bank, judgement, 3).pse, 0.4, 0.01);
  EXPECT_NEAR(banked(bank, judgement, 3).jnd, std::log1p(0.15) / 0.5, 0.02);
}

TEST(CueBankTest, BankAndClosedFormAgreeOfManyIntervalsAndOfYesOrNo) {
  Judgement judgement = judgement_of(0.15, 0, 1);
  judgement.criterion = 1;
  const Task three{.intervals = 3};
  EXPECT_NEAR(banked(made(0.8, 0, three), judgement, 3).jnd, judgement.jnd(three, 3, 0.8), 0.01);
  EXPECT_NEAR(banked_share(made(0.8, 0, three), judgement, 3, 0), 1.0 / 3, 1e-9);
  const CueBank one = made(0.8, 0, kYesNo);
  const Foretold by_form = closed_form(line_of(one), kYesNo, judgement, 3);
  EXPECT_NEAR(by_form.jnd, judgement.jnd(kYesNo, 3, 0.8), 1e-9);
  EXPECT_NEAR(by_form.pse, judgement.sd(3) / 0.8, 1e-9);
  EXPECT_NEAR(banked(one, judgement, 3).jnd, by_form.jnd, 0.015);
  EXPECT_NEAR(banked(one, judgement, 3).pse, by_form.pse, 0.015);
}

TEST(CueBankTest, WhatIsNotFeltHasNoBias) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const Foretold nothing = banked(made(0, 0, kBias), judgement, 3);
  EXPECT_TRUE(std::isinf(nothing.jnd));
  EXPECT_TRUE(std::isnan(nothing.pse));
}

TEST(CueBankTest, ASessionsOwnNoiseMakesTheJndLarger) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const FeltLine line = line_of(made(1, 0, kTwo, 0.2));
  EXPECT_NEAR(line.scatter, 0.2, 0.02);
  const double sd = std::sqrt(2.0) * judgement.sd(3);
  EXPECT_NEAR(closed_form(line, kTwo, judgement, 3).jnd * line.gain,
              std::log1p(0.15) * std::hypot(sd, line.scatter) / sd,
              1e-9);
  EXPECT_GT(banked(made(1, 0, kTwo, 0.2), judgement, 3).jnd,
            1.1 * banked(made(1, 0, kTwo), judgement, 3).jnd);
}

TEST(CueBankTest, WhereNothingIsFeltNothingIsForetold) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  CueBank bank = made(1, 0, kTwo);
  for (auto& level : bank.differences) {
    for (CueBank::Differences& one : level) one.clear();
  }
  EXPECT_TRUE(std::isinf(banked(bank, judgement, 3).jnd));
  EXPECT_TRUE(std::isinf(closed_form(line_of(bank), kTwo, judgement, 3).jnd));
  EXPECT_DOUBLE_EQ(banked_share(bank, judgement, 3, 1), 0.5);
}

TEST(CueBankTest, ResamplesAreOfTheSameSessions) {
  const CueBank bank = made(1, 0, kTwo, 0.2);
  const CueBank again = resampled(bank, 1, 2);
  EXPECT_NE(again.differences, bank.differences);
  for (std::size_t level = 0; level < bank.levels.size(); ++level) {
    for (const CueBank::Differences& one : again.differences[level]) {
      EXPECT_NE(std::find(bank.differences[level].begin(), bank.differences[level].end(), one),
                bank.differences[level].end());
    }
  }
}

TEST(CueBankTest, SessionsFillItBothWaysRound) {
  const auto session = FeltSession::make({.name = "mmt",
                                          .coupling = "mmt",
                                          .up = "delay_ms: 1",
                                          .down = "delay_ms: 1",
                                          .grip = "mid"});
  const Judgement judgement = judgement_for(*session, {}, 0.15, 0);
  const CueBank bank = bank_of(*session,
                               judgement,
                               {.intervals = 3},
                               {0.1, 0.6},
                               2,
                               1,
                               [](std::size_t count, const auto& work) {
                                 for (std::size_t i = count; i-- > 0;) work(i);
                               });
  ASSERT_EQ(bank.differences.size(), 2U);
  for (const CueBank::Differences& one : bank.differences[1]) {
    ASSERT_EQ(one.size(), 2U) << "than each of the others";
    for (const double other : one) EXPECT_NEAR(other, 0.6, 0.25);
  }
}

// Two steps between three: each as large as the level, and right if both are seen.
TEST(CueBankTest, BankAndClosedFormAgreeOfRankings) {
  const Task rank{.intervals = 3, .ranks = true};
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const CueBank bank = made(0.8, 0, rank);
  EXPECT_NEAR(banked(bank, judgement, 3).jnd, judgement.jnd(rank, 3, 0.8), 0.01);
  EXPECT_NEAR(banked_share(bank, judgement, 3, 0), 1.0 / 6, 1e-9);
  EXPECT_NEAR(banked_share(bank, judgement, 3, 1.2), 1, 1e-3);
}

// Far below zero no tap is judged there, and guesses are right half of the time: a bias is where
// the share rises, not there.
TEST(CueBankTest, GuessesBelowABiasDoNotHideIt) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  CueBank bank = made(1, -0.6, kBias);
  const Foretold whole = banked(bank, judgement, 3);
  for (std::size_t level = 0; level < 3; ++level) {
    for (CueBank::Differences& one : bank.differences[level]) one.clear();
  }
  EXPECT_DOUBLE_EQ(banked_share(bank, judgement, 3, bank.levels[0]), 0.5);
  EXPECT_NEAR(banked(bank, judgement, 3).pse, whole.pse, 1e-9);
  EXPECT_NEAR(banked(bank, judgement, 3).jnd, whole.jnd, 1e-9);
}

}  // namespace
}  // namespace palp::study
