#include "study/closed_loop/felt_lag.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

constexpr double kDepth = 4e-3;  // [m]

/// Taps of a second, whose force depends on where the hand is, and was.
std::optional<double> lag_of(
    const std::function<double(const std::function<double(double)>&, double)>& force,
    int taps = 3) {
  const auto hand = [](double at) {
    return at < 0 ? 0.0 : kDepth / 2 * (1 - std::cos(2 * std::numbers::pi * at));
  };
  FeltLag lag;
  for (int tick = 0; tick < 1000 * taps; ++tick) {
    lag.feel(hand(tick * 1e-3), force(hand, tick * 1e-3));
  }
  return lag.lag();
}

// A sine that comes late by a phase is a spring with a damper of its tangent.
TEST(FeltLagTest, FindsHowLateASpringAnswers) {
  for (const double late : {0.0, 5e-3, 20e-3, 50e-3, 90e-3}) {
    const auto lag = lag_of([late](const auto& hand, double at) { return 110 * hand(at - late); });
    ASSERT_TRUE(lag);
    const double turn = 2 * std::numbers::pi;  // [rad/s], of a tap
    EXPECT_NEAR(*lag, 1e3 * std::tan(turn * late) / turn, 1.5) << late;
  }
}

// Whatever its stiffness, and whether the tissue curves.
TEST(FeltLagTest, DoesNotDependOnTheStiffness) {
  for (const double stiffness : {30.0, 110.0, 800.0}) {
    const auto curved = lag_of([stiffness](const auto& hand, double at) {
      return stiffness * std::pow(hand(at - 30e-3), 1.5) / std::sqrt(kDepth);
    });
    ASSERT_TRUE(curved);
    EXPECT_NEAR(*curved, 30, 5) << stiffness;
  }
}

TEST(FeltLagTest, ALawThatHoldsTheHandBackIsOutOfStepToo) {
  const auto lag = lag_of([](const auto& hand, double at) {
    return 110 * (hand(at) + 40e-3 * (hand(at + 1e-3) - hand(at - 1e-3)) / 2e-3);
  });
  ASSERT_TRUE(lag);
  EXPECT_NEAR(*lag, 40, 2);
}

TEST(FeltLagTest, WithoutForceNothingIsKnown) {
  EXPECT_FALSE(lag_of([](const auto&, double) { return 0.0; }));
  EXPECT_FALSE(lag_of([](const auto& hand, double at) { return 10 * hand(at); }));
  EXPECT_FALSE(FeltLag{}.lag());
}

TEST(FeltLagTest, AForceThatFallsWithDepthIsAsFarOutOfStepAsCanBe) {
  const auto lag = lag_of([](const auto& hand, double at) { return 110 * (kDepth - hand(at)); });
  ASSERT_TRUE(lag);
  EXPECT_EQ(*lag, FeltLag::kLagMax);
}

}  // namespace
}  // namespace palp::study
