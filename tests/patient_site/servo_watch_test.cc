#include "patient_site/servo_watch.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// Ticks until it is said that the axis does not follow; 5,000: never. `position`, `target`: of the
/// tick [m].
template <class Position, class Target>
int ticks_until_told(const Position& position, const Target& target) {
  ServoWatch watch;
  for (int i = 0; i < 5000; ++i) {
    if (watch.judge(position(i), target(i), kTick)) return i;
  }
  return 5000;
}

TEST(ServoWatchTest, WhoGoesElsewhereDoesNotFollowHoweverFast) {
  for (const double speed : {0.0, 1e-3, 10e-3, 0.1, -1e-3, -10e-3, -0.1}) {  // [m/s]
    const auto runs = [&](int i) { return 2e-3 * (speed < 0 ? -1 : 1) + 1e-3 * speed * i; };
    const int told = ticks_until_told(runs, [](int) { return 0.0; });
    EXPECT_NEAR(told, 300, 1) << speed;
  }
}

TEST(ServoWatchTest, WhoComesCloserFollowsHoweverLate) {
  for (const double speed : {2e-3, 20e-3, 0.1}) {
    const auto target = [&](int i) { return 1e-3 * speed * i; };
    const auto late = [&](int i) { return target(i) - 10e-3; };
    EXPECT_EQ(ticks_until_told(late, target), 5000) << speed;
  }
}

TEST(ServoWatchTest, AHandThatTapsLeadsALateStage) {
  for (const double lag : {0.0, 10.0, 30.0}) {  // [ticks]
    const auto at = [](double i) { return 4e-3 * std::sin(2 * std::numbers::pi * 5e-3 * i); };
    const int told = ticks_until_told([&](int i) { return at(i - lag); }, at);
    EXPECT_EQ(told, 5000) << lag;
  }
}

TEST(ServoWatchTest, WhoTurnsRoundAfterAWhileFollows) {
  const auto overshoots = [](int i) { return i < 200 ? 1e-5 * i : 2e-3 - 1e-5 * (i - 200); };
  const int told = ticks_until_told(overshoots, [](int i) { return i < 390 ? -5e-3 : -2e-3; });
  EXPECT_GT(told, 390);
}

}  // namespace
}  // namespace palp::patient
