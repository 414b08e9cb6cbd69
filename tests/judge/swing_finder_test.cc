#include "judge/swing_finder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::judge {
namespace {

/// [m], of 3 s of a motion over time [s].
double largest_of(const std::function<double(double)>& position) {
  SwingFinder finder;
  for (int i = 0; i < 3000; ++i) finder.look({1e-3 * i, position(1e-3 * i)});
  return finder.largest();
}

double sine(double amplitude, double frequency, double at) {
  return amplitude * std::sin(2 * std::numbers::pi * frequency * at);
}

RC_GTEST_PROP(SwingFinderTest, ALimitCycleIsFoundAtItsSizeWhateverItRidesOn, ()) {
  const double swing = 1e-5 * *rc::gen::inRange(20, 300);  // [m]
  const double frequency = *rc::gen::inRange(8, 50);       // [Hz]
  const double drift = 1e-4 * *rc::gen::inRange(-10, 10);  // [m/s]
  const double found =
      largest_of([&](double t) { return sine(swing / 2, frequency, t) + drift * t; });
  RC_ASSERT(std::abs(found - swing) < 0.08 * swing + 1e-3 / frequency);
}

TEST(SwingFinderTest, WhatAPersonMeansIsNone) {
  EXPECT_EQ(largest_of([](double t) { return sine(2e-3, 5, t); }), 0);
  EXPECT_EQ(largest_of([](double t) { return sine(2e-3, 0.5, t); }), 0);
}

TEST(SwingFinderTest, TremorIsNone) {
  EXPECT_EQ(largest_of([](double t) { return sine(0.03e-3, 9.3, t); }), 0);
}

TEST(SwingFinderTest, WhatRingsDownIsNone) {
  const auto ringing = [](double t) { return 1e-3 * std::exp(-t / 0.05) * std::cos(110 * t); };
  EXPECT_LT(largest_of(ringing), 0.3e-3);
}

TEST(SwingFinderTest, FivePeriodsOnEndAreAsked) {
  const auto bursts = [](double t) { return std::fmod(t, 0.6) < 0.3 ? sine(1e-3, 12, t) : 0; };
  EXPECT_EQ(largest_of(bursts), 0);
}

/// [m], of 3 s of a hand that swings by 2 mm at 12 Hz against a spring, which gives back what it
/// took, and besides `power` [W].
double largest_against_a_spring(double power) {
  SwingFinder finder;
  for (int i = 0; i < 3000; ++i) {
    const double at = 1e-3 * i;
    const double x = sine(1e-3, 12, at);
    const double pressed = std::max(0.0, x);
    finder.look({at, x, power * at - 0.5 * 400 * pressed * pressed});
  }
  return finder.largest();
}

TEST(SwingFinderTest, WhatPaysForItsSwingsDoesNotSwingByItself) {
  EXPECT_EQ(largest_against_a_spring(-1e-4), 0);
  EXPECT_EQ(largest_against_a_spring(0), 0);
  EXPECT_NEAR(largest_against_a_spring(1e-4), 2e-3, 0.05e-3);
}

/// A hand that bounces once in each tap of 5 Hz turns 20 times a second, and presses a spring.
TEST(SwingFinderTest, AQuickTapThatBouncesDoesNotSwingByItselfThoughItEndsInTheAir) {
  SwingFinder finder;
  const auto depth = [](double t) {
    if (t > 2) return -3e-3 + 2e-3 * std::min(1.0, 20 * (t - 2));
    return 1e-3 + sine(2e-3, 5, t) + sine(1.5e-3, 10, t);
  };
  double given = 0;
  for (int i = 1; i < 3000; ++i) {
    const double x = depth(1e-3 * i);
    const double before = depth(1e-3 * (i - 1));
    given -= (std::max(0.0, 400 * before) + 0.5 * (x - before) / 1e-3) * (x - before);
    finder.look({1e-3 * i, x, given});
  }
  EXPECT_EQ(finder.largest(), 0);
  SwingFinder blind;
  for (int i = 0; i < 3000; ++i) blind.look({1e-3 * i, depth(1e-3 * i)});
  EXPECT_GT(blind.largest(), 0.5e-3) << "by its turns alone";
}

TEST(SwingFinderTest, ASlowerFinderFindsWhatAPersonMeans) {
  SwingFinder finder{4};
  for (int i = 0; i < 3000; ++i) finder.look({1e-3 * i, sine(1e-3, 5, 1e-3 * i)});
  EXPECT_NEAR(finder.largest(), 2e-3, 0.05e-3);
}

TEST(SwingFinderTest, ABreakOfTheMotionEndsARow) {
  SwingFinder finder;
  for (int i = 0; i < 3000; ++i) {
    if (i % 300 == 0) finder.restart();
    finder.look({1e-3 * i, sine(1e-3, 12, 1e-3 * i)});
  }
  EXPECT_EQ(finder.largest(), 0);
}

}  // namespace
}  // namespace palp::judge
