#include "judge/swing_finder.h"

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
  for (int i = 0; i < 3000; ++i) finder.look(1e-3 * i, position(1e-3 * i));
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

TEST(SwingFinderTest, ABreakOfTheMotionEndsARow) {
  SwingFinder finder;
  for (int i = 0; i < 3000; ++i) {
    if (i % 300 == 0) finder.restart();
    finder.look(1e-3 * i, sine(1e-3, 12, 1e-3 * i));
  }
  EXPECT_EQ(finder.largest(), 0);
}

}  // namespace
}  // namespace palp::judge
