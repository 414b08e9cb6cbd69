#include "netem/model/exact_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "tests/netem/model/impairment_builders.h"
#include "tests/netem/model/outcomes.h"

namespace palp::netem {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(ExactModelTest, SwapsLetAFewOvertakeAsManyAsAsked) {
  std::vector<TimePoint> releases;
  for (const PacketOutcome& outcome :
       outcomes_of(impaired("delay 50ms order swap 5% depth 3"), 20'000)) {
    releases.push_back(outcome.copies[0].release);
  }
  double swaps = 0;
  for (std::size_t i = 4; i < releases.size(); ++i) {
    std::size_t overtaken = 0;
    for (std::size_t k = 1; k <= 8 && k <= i; ++k) overtaken += releases[i] < releases[i - k];
    EXPECT_LE(overtaken, 3U + 8U);
    swaps += overtaken >= 3 ? 1 : 0;
  }
  EXPECT_NEAR(swaps / 20'000, 0.05, 4 * std::sqrt(0.05 * 0.95 / 20'000));
}

TEST(ExactModelTest, ARateSerialisesAndItsQueueDropsTheTail) {
  // 242 bytes at 1 Mbit/s take 1.936 ms: two a millisecond fill any queue.
  const auto outcomes = outcomes_of(impaired("rate 1mbit queue packets 10"), 1000, milliseconds{1});
  TimePoint last{};
  double dropped = 0;
  for (const PacketOutcome& outcome : outcomes) {
    if (outcome.copies[0].verdict == Verdict::OverLimit) {
      dropped += 1;
      continue;
    }
    if (last != TimePoint{}) {
      EXPECT_EQ(outcome.copies[0].release - last, Duration{1'936'000});
    }
    last = outcome.copies[0].release;
  }
  EXPECT_NEAR(dropped / 1000, 1 - 1 / 1.936, 0.02);
}

TEST(ExactModelTest, CodelKeepsAStandingQueueShort) {
  // Half a per cent too much, for 12 s: CoDel drops ever more often until the queue is short.
  const auto wait = [](const char* words) {
    Duration longest{};
    const auto outcomes = outcomes_of(impaired(words), 100'000, Duration{120'000});
    for (std::size_t i = outcomes.size() / 2; i < outcomes.size(); ++i) {
      if (outcomes[i].copies[0].verdict != Verdict::Delivered) continue;
      longest = std::max(longest,
                         outcomes[i].copies[0].release -
                             TimePoint{Duration{120'000} * static_cast<std::int64_t>(i)});
    }
    return longest;
  };
  EXPECT_GT(wait("rate 16.05mbit"), milliseconds{50});
  EXPECT_LT(wait("rate 16.05mbit queue codel"), milliseconds{15});
}

TEST(ExactModelTest, FlippedBitsInHeadersAreLostAndInThePayloadArrive) {
  double header = 0;
  double payload = 0;
  for (const PacketOutcome& outcome : outcomes_of(impaired("corrupt 30%"), 40'000)) {
    header += outcome.copies[0].verdict == Verdict::HeaderHit ? 1 : 0;
    payload +=
        outcome.copies[0].verdict == Verdict::Delivered && outcome.copies[0].flipped_bit >= 0;
  }
  const double share = 0.3 * 42 / 242;
  EXPECT_NEAR(header / 40'000, share, 4 * std::sqrt(share / 40'000));
  EXPECT_NEAR((header + payload) / 40'000, 0.3, 4 * std::sqrt(0.21 / 40'000));
  for (const PacketOutcome& outcome : outcomes_of(impaired("corrupt 30% payload"), 2000)) {
    EXPECT_EQ(outcome.copies[0].verdict, Verdict::Delivered);
  }
}

TEST(ExactModelTest, SlotsReleaseOnTheirGridWithinTheirBudget) {
  std::map<TimePoint, int> slots;
  for (const PacketOutcome& outcome :
       outcomes_of(impaired("delay 5ms slot 4ms 8ms packets 7"), 20'000)) {
    ++slots[outcome.copies[0].release];
  }
  TimePoint last{};
  for (const auto& [at, count] : slots) {
    EXPECT_LE(count, 7);
    if (last != TimePoint{}) {
      EXPECT_GE(at - last, milliseconds{4});
    }
    last = at;
  }
}

TEST(ExactModelTest, AnEvenGridStaysItselfOverAGapOfAnyLength) {
  for (const Duration period : {microseconds{255'300}, microseconds{5'100'700}}) {
    for (const PacketOutcome& outcome : outcomes_of(impaired("slot 1ms"), 200, period)) {
      EXPECT_EQ(outcome.copies[0].release.time_since_epoch() % milliseconds{1}, Duration{});
    }
  }
}

TEST(ExactModelTest, ASlotOfAnUnevenGridIsAsNearAfterALongGapAsAfterAShortOne) {
  const auto wait = [](Duration period) {
    const auto outcomes = outcomes_of(impaired("slot 1ms 3ms"), 20'000, period);
    Duration sum{};
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      sum += outcomes[i].copies[0].release - TimePoint{period * static_cast<std::int64_t>(i)};
    }
    return seconds(sum) / 20'000;
  };
  // E[step^2] / (2 E[step]) of steps even between 1 and 3 ms is 1.083 ms; its spread 0.71.
  for (const Duration period : {microseconds{100'300}, microseconds{3'000'300}}) {
    EXPECT_NEAR(wait(period), 1.083e-3, 4 * 0.71e-3 / std::sqrt(20'000));
  }
}

TEST(ExactModelTest, LongDatagramsDoNotFitTheMtu) {
  ImpairmentModel sequence{impaired("mtu 128"), 1, Direction::Up, TimePoint{}};
  EXPECT_EQ(sequence.next({.length = 100, .room = 9})[0].verdict, Verdict::Delivered);
  EXPECT_EQ(sequence.next({.length = 101, .room = 9})[0].verdict, Verdict::OverLimit);
}

TEST(ExactModelTest, EcnMarksWhatCanBeMarkedAndDscpIsCleared) {
  ImpairmentModel sequence{impaired("loss 100% ecn dscp-clear"), 1, Direction::Up, TimePoint{}};
  const CopyOutcome marked = sequence.next({.length = 1, .room = 9, .tos = 0xb9})[0];
  EXPECT_EQ(marked.verdict, Verdict::Delivered);
  EXPECT_EQ(marked.tos, 3);
  EXPECT_EQ(sequence.next({.length = 1, .room = 9, .tos = 0xb8})[0].verdict, Verdict::Lost);
}

}  // namespace
}  // namespace palp::netem
