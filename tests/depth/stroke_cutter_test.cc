#include "depth/stroke_cutter.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace palp::depth {
namespace {

using Event = StrokeCutter::Event;

/// Follows straight lines between positions [mm], 1 mm in 40 ms; tissue from 0, 0.1 N/mm.
struct Hand {
  StrokeCutter cutter{StrokeCutterConfig{}};
  std::vector<Event> events;
  double position_mm{-3};
  TimePoint now{};

  void step() {
    now += std::chrono::milliseconds{1};
    StrokeSample sample;
    sample.measured.at = now;
    sample.position = position_mm * 1e-3;
    sample.force = std::max(0.0, 0.1 * position_mm);
    const Event event = cutter.add(sample);
    if (event != Event::None) events.push_back(event);
  }
  void move(double to_mm) {
    const double from = position_mm;
    const int steps = std::max(1, static_cast<int>(std::abs(to_mm - from) * 40));
    for (int i = 1; i <= steps; ++i) {
      position_mm = from + (to_mm - from) * i / steps;
      step();
    }
  }
  void stay(int steps) {
    for (int i = 0; i < steps; ++i) step();
  }
};

TEST(StrokeCutterTest, CutsFromTheAirToTheReversal) {
  Hand hand;
  hand.stay(50);
  hand.move(4);
  EXPECT_TRUE(hand.events.empty());
  hand.move(3);
  ASSERT_EQ(hand.events, std::vector{Event::Reversed});
  const auto loading = hand.cutter.loading();
  EXPECT_NEAR(loading.back().position, 4e-3, 1e-9);
  EXPECT_LE(loading.front().position, -2.9e-3);
  for (std::size_t i = 1; i < loading.size(); ++i) {
    EXPECT_GE(loading[i].position, loading[i - 1].position - 1e-12);
  }
  hand.move(-3);
  EXPECT_EQ(hand.events, (std::vector{Event::Reversed, Event::Released}));
}

TEST(StrokeCutterTest, AHoldOnTheWayIsStillOneStroke) {
  Hand hand;
  hand.move(2);
  hand.stay(2000);
  hand.move(1.8);  // less than the reversal: a tremor
  hand.move(4);
  hand.move(-3);
  EXPECT_EQ(hand.events, (std::vector{Event::Reversed, Event::Released}));
  EXPECT_FALSE(hand.cutter.pressed_again());
}

TEST(StrokeCutterTest, SaysWhenTheTipPressedOnAfterGoingBack) {
  Hand hand;
  hand.move(2);
  hand.move(1.2);
  hand.move(4);
  EXPECT_TRUE(hand.cutter.pressed_again());
  hand.move(3);
  EXPECT_EQ(hand.events, (std::vector{Event::Reversed, Event::Reversed}));
  hand.move(-3);
  hand.move(4);
  EXPECT_FALSE(hand.cutter.pressed_again()) << "a new stroke is a new story";
}

TEST(StrokeCutterTest, EachTapIsAStroke) {
  Hand hand;
  for (int i = 0; i < 3; ++i) {
    hand.move(4);
    hand.move(-3);
    hand.stay(100);
  }
  EXPECT_EQ(hand.events.size(), 6U);
}

TEST(StrokeCutterTest, ALeadNeverHoldsTheReturnOfTheStrokeBefore) {
  Hand hand;
  hand.move(4);
  hand.move(-1);
  hand.move(4);
  hand.move(3);
  EXPECT_LE(hand.cutter.loading().front().force, 0);
  for (std::size_t i = 1; i < hand.cutter.loading_count(); ++i) {
    EXPECT_GE(hand.cutter.loading()[i].position, hand.cutter.loading()[i - 1].position);
  }
}

TEST(StrokeCutterTest, AStreamThatBeginsInContactWaitsForTheAir) {
  Hand hand;
  hand.position_mm = 2;
  hand.stay(10);
  hand.move(4);
  hand.move(1);
  EXPECT_TRUE(hand.events.empty());
  hand.move(-3);
  hand.move(4);
  hand.move(3);
  EXPECT_EQ(hand.events, std::vector{Event::Reversed});
}

TEST(StrokeCutterTest, AVeryLongHoldIsThinnedNotCut) {
  Hand hand;
  hand.move(2);
  hand.stay(60'000);
  hand.move(4);
  hand.move(3);
  EXPECT_EQ(hand.events, std::vector{Event::Reversed});
  EXPECT_LE(hand.cutter.samples().size(), 16'384U);
  EXPECT_NEAR(hand.cutter.loading().back().position, 4e-3, 0.3e-3);
  EXPECT_LE(hand.cutter.loading().front().position, -2.9e-3);
}

}  // namespace
}  // namespace palp::depth
