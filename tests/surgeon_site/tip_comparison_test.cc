#include "surgeon_site/tip_comparison.h"

#include <functional>

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

constexpr double kTick = 1e-3;  // [s]

/// What both ends do, by the time [s]. The tip's force comes a round trip and its devices' lags
/// after the hand was there.
struct Ends {
  std::function<double(double)> given = [](double /*at*/) { return 1.0; };     ///< [N]
  std::function<double(double)> measured = [](double /*at*/) { return 1.0; };  ///< [N]
  std::function<double(double)> position = [](double /*at*/) { return 0.0; };  ///< [m]
  double tip{1};                                                               ///< [m], deeper
  double round_trip{0.1};                                                      ///< [s]
  PatientDevices devices{};
};

/// [s], when it says that the tip measures more for the first time; `lasts` [s]: never.
double says_at(const Ends& ends, double lasts) {
  TipComparison comparison;
  for (int tick = 0; tick * kTick < lasts; ++tick) {
    const double at = tick * kTick;
    comparison.look({.given = ends.given(at),
                     .measured = ends.measured(at),
                     .position = ends.position(at),
                     .tip = ends.tip,
                     .round_trip = ends.round_trip},
                    ends.devices,
                    kTick);
    if (comparison.says_more()) return at;
  }
  return lasts;
}

TEST(TipComparisonTest, SaysSoonWhatIsMuchAndLaterWhatIsLittle) {
  const auto more = [](double by) {
    return says_at({.measured = [=](double at) { return at < 1 ? 1.0 : 1 + by; }}, 9) - 1;
  };
  EXPECT_LT(more(0.5), 0.05);
  EXPECT_LT(more(0.1), 0.15);
  EXPECT_LT(more(0.5), more(0.1));
  EXPECT_EQ(more(0.04), 8) << "the noise of a model";
  EXPECT_EQ(more(-0.5), 8) << "a hand that feels too much";
}

TEST(TipComparisonTest, AStepOfTheSensorIsNoDifference) {
  // 0.325 N, told in steps of 50 mN.
  const auto stepped = [](double at) { return static_cast<int>(at * 37) % 2 == 0 ? 0.3 : 0.35; };
  EXPECT_EQ(says_at({.given = [](double /*at*/) { return 0.3; }, .measured = stepped}, 5), 5);
  Ends coarse{.measured = [](double /*at*/) { return 1.08; }};
  EXPECT_LT(says_at(coarse, 5), 1);
  coarse.devices.sensor.step = 0.2;
  EXPECT_EQ(says_at(coarse, 5), 5);
}

/// The hand was given at each instant what the tip met there: late, but the same.
TEST(TipComparisonTest, NewsOfAnEarlierInstantIsHeldAgainstThatInstant) {
  for (const double round_trip : {0.0, 0.1, 0.5, 1.5}) {
    const auto force = [](double at) { return at < 3 ? 1.0 : 0.4; };
    Ends ends{.given = force, .round_trip = round_trip};
    const double late = round_trip + ends.devices.stage.lag + ends.devices.sensor.lag;
    ends.measured = [=](double at) { return force(at - late); };
    EXPECT_EQ(says_at(ends, 6), 6) << round_trip;
  }
}

/// A law that takes its force back under a hand at rest: in the tissue there is no less for that.
TEST(TipComparisonTest, AHandAsDeepAsTheTipGetsNoLessThanTheTipMeasures) {
  const auto given = [](double at) { return at < 2 ? 1.0 : 0.5; };
  Ends ends{.given = given, .tip = 0, .round_trip = 0.7};
  EXPECT_LT(says_at(ends, 6), 2.1) << "without a round trip";
  ends.tip = 1;
  EXPECT_GT(says_at(ends, 6), 2.7) << "it may have moved out";
}

TEST(TipComparisonTest, AHandThatMovedSaysNothing) {
  const auto swing = [](double speed) {
    return says_at({.measured = [](double /*at*/) { return 1.3; },
                    .position = [=](double at) { return speed * at; }},
                   3);
  };
  EXPECT_LT(swing(5e-3), 1) << "it creeps";
  EXPECT_EQ(swing(12e-3), 3);
}

TEST(TipComparisonTest, WhatIsOverIsNotSaidAnyMore) {
  TipComparison comparison;
  const auto run = [&](double measured, double lasts) {
    for (int tick = 0; tick * kTick < lasts; ++tick) {
      comparison.look({.given = 1, .measured = measured, .tip = 1, .round_trip = 0.05}, {}, kTick);
    }
  };
  run(1.3, 1);
  EXPECT_TRUE(comparison.says_more());
  EXPECT_NEAR(comparison.more(), 0.3, 1e-3);
  run(1.0, 0.05);
  EXPECT_TRUE(comparison.says_more()) << "for a moment";
  run(1.0, 0.3);
  EXPECT_FALSE(comparison.says_more());
  run(1.3, 1);
  comparison.restart();
  EXPECT_FALSE(comparison.says_more());
  EXPECT_EQ(comparison.more(), 0);
}

TEST(TipComparisonTest, LateTicksCountForTheirTime) {
  TipComparison comparison;
  double at = 0;
  for (; at < 0.5 && !comparison.says_more(); at += 5e-3) {
    comparison.look({.given = 1, .measured = 1.5, .tip = 1, .round_trip = 0.05}, {}, 5e-3);
  }
  EXPECT_NEAR(
      at, says_at({.measured = [](double /*at*/) { return 1.5; }, .round_trip = 0.05}, 1), 0.02);
}

}  // namespace
}  // namespace palp::surgeon
