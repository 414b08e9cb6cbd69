#include "patient_site/breath.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

constexpr double kStep = 1e-3;  // [s]

/// [s], 0 to `until`, every `step`.
std::vector<double> times(double until, double step) {
  std::vector<double> out(static_cast<std::size_t>(std::lround(until / step)));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = step * static_cast<double>(i);
  return out;
}
constexpr BreathConfig kVaried{.amplitude = 1e-3, .frequency = 0.25, .variation = 0.3, .seed = 7};

/// Where it turns: instants [s] and positions [m].
struct Turn {
  double at{};
  double position{};
};
std::vector<Turn> turns_of(const BreathConfig& config, double until) {
  Breath breath{config};
  std::vector<Turn> turns;
  double before = breath.at(0).velocity;
  for (const double t : times(until, kStep)) {
    const Breath::Motion now = breath.at(t);
    if (before * now.velocity < 0) turns.push_back({t, now.position});
    before = now.velocity;
  }
  return turns;
}

TEST(BreathTest, WithoutAnAmplitudeTheSurfaceStandsStill) {
  Breath breath{{.amplitude = 0, .frequency = 0.25, .variation = 0.3}};
  for (const double t : times(20, 0.1)) {
    EXPECT_EQ(breath.at(t).position, 0);
    EXPECT_EQ(breath.at(t).velocity, 0);
  }
}

TEST(BreathTest, WithoutVariationItIsASine) {
  Breath breath{{.amplitude = 2e-3, .frequency = 0.3}};
  const double omega = 2 * std::numbers::pi * 0.3;
  for (const double t : times(20, 0.01)) {
    const Breath::Motion now = breath.at(t);
    EXPECT_DOUBLE_EQ(now.position, 2e-3 * std::sin(omega * t));
    EXPECT_DOUBLE_EQ(now.velocity, 2e-3 * omega * std::cos(omega * t));
  }
}

TEST(BreathTest, TheLeastVariationIsNearlyTheSine) {
  BreathConfig config{.amplitude = 2e-3, .frequency = 0.3};
  Breath sine{config};
  config.variation = 1e-9;
  Breath varied{config};
  for (const double t : times(20, 0.01)) {
    EXPECT_NEAR(sine.at(t).position, varied.at(t).position, 1e-10);
  }
}

TEST(BreathTest, VelocityIsTheDerivativeAndNeverJumps) {
  Breath breath{kVaried};
  Breath::Motion before = breath.at(0);
  // Half a cosine of 0.7 times the usual length, from one deepest turn to the other.
  const double rate_most = 2 * std::numbers::pi * 0.25 / 0.7;
  const double change_most = 1.3e-3 * rate_most * rate_most * kStep;
  for (const double t : times(200, kStep)) {
    const Breath::Motion now = breath.at(t + kStep);
    EXPECT_NEAR((now.position - before.position) / kStep,
                0.5 * (now.velocity + before.velocity),
                change_most);
    EXPECT_LE(std::abs(now.velocity - before.velocity), 1.01 * change_most);
    before = now;
  }
}

TEST(BreathTest, EachHalfVariesByNoMoreThanItsShareAndByMostOfIt) {
  const std::vector<Turn> turns = turns_of(kVaried, 1000);
  double shortest = 1;
  double longest = 1;
  double shallowest = 1;
  double deepest = 1;
  for (std::size_t i = 1; i < turns.size(); ++i) {
    const double span = (turns[i].at - turns[i - 1].at) / 2;  // of 2 s
    const double depth = std::abs(turns[i].position) / 1e-3;
    EXPECT_LT(turns[i].position * turns[i - 1].position, 0) << "in and out by turns";
    shortest = std::min(shortest, span);
    longest = std::max(longest, span);
    shallowest = std::min(shallowest, depth);
    deepest = std::max(deepest, depth);
  }
  EXPECT_GE(shortest, 0.699);
  EXPECT_LE(longest, 1.301);
  EXPECT_GE(shallowest, 0.699);
  EXPECT_LE(deepest, 1.301);
  EXPECT_LT(shortest, 0.75);
  EXPECT_GT(longest, 1.25);
  EXPECT_LT(shallowest, 0.75);
  EXPECT_GT(deepest, 1.25);
}

TEST(BreathTest, AnotherSeedIsAnotherBreathAndTheSameTheSame) {
  BreathConfig other = kVaried;
  other.seed = 8;
  Breath one{kVaried};
  Breath same{kVaried};
  Breath another{other};
  double apart = 0;
  for (const double t : times(30, 0.01)) {
    const double position = one.at(t).position;
    EXPECT_EQ(position, same.at(t).position);
    apart = std::max(apart, std::abs(position - another.at(t).position));
  }
  EXPECT_GT(apart, 0.3e-3);
}

TEST(BreathTest, AskedSeldomItIsWhereItWouldBe) {
  Breath often{kVaried};
  Breath seldom{kVaried};
  for (const double t : times(100, 0.5)) {
    for (const double s : times(0.5, 0.01)) (void)often.at(t + s);
    EXPECT_NEAR(often.at(t + 0.5).position, seldom.at(t + 0.5).position, 1e-15);
  }
}

}  // namespace
}  // namespace palp::patient
