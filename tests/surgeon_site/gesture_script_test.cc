#include "surgeon_site/gesture_script.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "surgeon_site/script_builder.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""ns;

constexpr double kStiffness = 300;  // [N/m], mid grip

double aim(double depth) { return depth + 1897 * std::pow(depth, 1.5) / kStiffness; }

GestureScript standard() { return standard_script({.hand_stiffness = kStiffness}); }

TEST(GestureScriptTest, StandardPalpationLasts33Point7Seconds) {
  EXPECT_EQ(standard().length(), 33700ms);
  EXPECT_EQ(standard_script({kStiffness, 500ms}).length(), 33700ms);
}

TEST(GestureScriptTest, HoldsOfStandardGrowWithFourRoundTrips) {
  EXPECT_EQ(standard_script({kStiffness, 1000ms}).length(), 21700ms + 6 * 4000ms);
}

TEST(GestureScriptTest, DemoTakesAbout25Seconds) {
  const GestureScript script = demo_script({kStiffness, {}});
  EXPECT_GE(script.length(), 24s);
  EXPECT_LE(script.length(), 26s);
  int taps = 0;
  for (const Stretch& stretch : script.stretches()) taps += stretch.kind == StretchKind::Tap;
  EXPECT_EQ(taps, 8);
}

TEST(GestureScriptTest, StandardBeginsAndEndsAtMinusTenMillimetres) {
  const GestureScript script = standard();
  EXPECT_DOUBLE_EQ(script.at(0s).position, -10e-3);
  EXPECT_DOUBLE_EQ(script.at(999ms).position, -10e-3);
  EXPECT_NEAR(script.at(script.length()).position, -10e-3, 1e-12);
  EXPECT_NEAR(script.at(script.length() + 10s).position, -10e-3, 1e-12);
  EXPECT_EQ(script.at(script.length()).velocity, 0);
}

TEST(GestureScriptTest, FreeAirIsASineOfFiveMillimetres) {
  const GestureScript script = standard();
  EXPECT_NEAR(script.at(1250ms).position, -5e-3, 1e-12);
  EXPECT_NEAR(script.at(1750ms).position, -15e-3, 1e-12);
  EXPECT_NEAR(script.at(4250ms).position, -5e-3, 1e-12);
}

TEST(GestureScriptTest, TapsAimBeyondTheDepthByTheHandsDeflection) {
  const GestureScript script = standard();
  // Site A's first tap begins at 6 s and is deepest half a second later.
  EXPECT_NEAR(script.at(6s).position, -3e-3, 1e-12);
  EXPECT_NEAR(script.at(6500ms).position, aim(4e-3), 1e-12);
  EXPECT_NEAR(script.at(7s).position, -3e-3, 1e-12);
  EXPECT_NEAR(script.at(7400ms).position, -3e-3, 1e-12);
  EXPECT_NEAR(script.at(8s).position, aim(4e-3), 1e-12);
}

TEST(GestureScriptTest, PressesHoldTwoAndFourMillimetres) {
  const GestureScript script = standard();
  EXPECT_NEAR(script.at(12600ms).position, aim(2e-3), 1e-12);
  EXPECT_NEAR(script.at(14599ms).position, aim(2e-3), 1e-12);
  EXPECT_NEAR(script.at(15s).position, aim(4e-3), 1e-12);
  EXPECT_NEAR(script.at(16999ms).position, aim(4e-3), 1e-12);
  EXPECT_NEAR(script.at(17600ms).position, -10e-3, 1e-12);
}

TEST(GestureScriptTest, PlaceChangesOnlyWhileTheHandIsClear) {
  const GestureScript script = standard();
  Place place = script.at(0s).place;
  int changes = 0;
  for (Duration t{}; t <= script.length(); t += 1ms) {
    const Intent intent = script.at(t);
    if (intent.place != place) {
      EXPECT_NEAR(intent.position, -10e-3, 1e-9);
      EXPECT_EQ(t, 19600ms);
      ++changes;
    }
    place = intent.place;
  }
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(place, kSiteB);
}

TEST(GestureScriptTest, PositionIsContinuousAndVelocityIsItsRate) {
  const GestureScript script = standard();
  for (Duration t{}; t + 1ms <= script.length(); t += 1ms) {
    const Intent left = script.at(t);
    const Intent right = script.at(t + 1ms);
    const double rate = (right.position - left.position) / 1e-3;
    ASSERT_LT(std::abs(rate), 0.05) << seconds(t);
    // The sine of free air starts and stops with a kink; everything else is smooth.
    if (t >= 999ms && t < 1001ms) continue;
    if (t >= 4998ms && t < 5001ms) continue;
    ASSERT_NEAR((left.velocity + right.velocity) / 2, rate, 2e-4) << seconds(t);
  }
}

TEST(GestureScriptTest, PhasesAreNumberedAndNamed) {
  const GestureScript script = standard();
  ASSERT_EQ(script.phases().size(), 13U);
  EXPECT_EQ(script.phase_at(0s), 1U);
  EXPECT_EQ(script.phase_at(1s), 2U);
  EXPECT_EQ(script.phase_at(999999999ns), 1U);
  EXPECT_EQ(script.phase(2).name, "free air");
  EXPECT_EQ(script.phase(5).name, "taps A");
  EXPECT_EQ(script.phase(12).name, "press 4 mm B");
  EXPECT_EQ(script.phase_at(script.length() + 1s), 13U);
}

TEST(GestureScriptTest, ReplayInterpolatesLinearly) {
  const GestureScript script{std::vector<ReplayPoint>{{0ms, -10e-3, {}},
                                                      {100ms, -8e-3, {}},
                                                      {300ms, -8e-3, {10e-3, 0}},
                                                      {400ms, 2e-3, {10e-3, 0}}}};
  EXPECT_EQ(script.length(), 400ms);
  EXPECT_DOUBLE_EQ(script.at(50ms).position, -9e-3);
  EXPECT_DOUBLE_EQ(script.at(50ms).velocity, 0.02);
  EXPECT_DOUBLE_EQ(script.at(200ms).place.x, 5e-3);
  EXPECT_DOUBLE_EQ(script.at(350ms).position, -3e-3);
  EXPECT_DOUBLE_EQ(script.at(400ms).position, 2e-3);
  EXPECT_DOUBLE_EQ(script.at(1s).position, 2e-3);
  EXPECT_EQ(script.at(1s).velocity, 0);
}

TEST(GestureScriptTest, SitesHaveNames) {}

}  // namespace
}  // namespace palp::surgeon
