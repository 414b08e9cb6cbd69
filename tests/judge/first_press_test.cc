#include "judge/first_press.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

/// Air for a second, then contact for `seconds`: `share` of the true force is felt.
FirstPress pressed(double seconds, double share) {
  FirstPress press;
  for (int i = 0; i < 1000; ++i) press.look({.at = 1e-3 * i});
  for (int i = 0; i < 1000 * seconds; ++i)
    press.look({.at = 1 + 1e-3 * i, .felt = 0.8 * share, .truth = 0.8});
  return press;
}

TEST(FirstPressTest, SaysHowMuchOfTheForceIsFelt) {
  EXPECT_NEAR(pressed(3, 0.6).share(), 0.6, 1e-12);
}

TEST(FirstPressTest, OneThatIsLetGoOfBeforeDoesNotCount) {
  EXPECT_TRUE(std::isnan(pressed(2.6, 0.6).share()));
  EXPECT_TRUE(std::isnan(FirstPress{}.share()));
}

TEST(FirstPressTest, OnlyTheFirstCounts) {
  FirstPress press = pressed(1, 0.6);
  press.look({.at = 2.1});
  for (int i = 0; i < 4000; ++i) press.look({.at = 3 + 1e-3 * i, .felt = 0.8, .truth = 0.8});
  EXPECT_TRUE(std::isnan(press.share()));
}

constexpr double kTissue = 500;  // [N/m]

/// A hand that goes 6 mm into a tissue, feels nothing of it, and has given `work` [J].
double permitted(const EnergyBound& bound, double work) {
  FirstPress press{bound};
  for (int i = 0; i < 3000; ++i) {
    const double position = std::min(6e-3, 1e-5 * i);
    press.look({.at = 1e-3 * i, .truth = kTissue * position, .position = position, .work = work});
  }
  return press.permitted();
}

TEST(FirstPressTest, TheEnergyPermitsAForceOfItsRootOverTheGrip) {
  // F^2/2k = 1 mJ, and the hand goes out by F/k.
  for (const double grip : {60.0, 80.0, 120.0}) {
    const double force = std::sqrt(2 * grip * 1e-3);
    const double truth = kTissue * (6e-3 - force / grip);
    EXPECT_NEAR(permitted({.grip = grip, .energy = 1e-3}, 0), std::min(1.0, force / truth), 1e-3);
  }
}

TEST(FirstPressTest, WhatTheHandGaveBeforeItMayHaveBack) {
  EXPECT_LT(permitted({.grip = 80, .energy = 0.5e-3}, 0), 0.8);
  EXPECT_EQ(permitted({.grip = 80, .energy = 0.5e-3}, 0.3e-3),
            permitted({.grip = 80, .energy = 0.8e-3}, 0));
}

TEST(FirstPressTest, WhereEnergyPermitsAllNoMoreThanTheTissueCounts) {
  EXPECT_NEAR(permitted({.grip = 900, .energy = 3e-3}, 0), 1, 1e-6);
}

TEST(FirstPressTest, WithoutABoundNothingIsPermittedOrForbidden) {
  EXPECT_TRUE(std::isnan(permitted({}, 0)));
}

TEST(FirstPressTest, WhatTheHandWasGivenInVainWasPermittedAllTheSame) {
  FirstPress press{{.grip = 80, .energy = 1e-3}};
  const double force = std::sqrt(2 * 80 * 1e-3);
  for (int i = 0; i < 3000; ++i) {
    const double out = 0.5 * std::clamp(1e-3 * (i - 1000), 0.0, 1.0);  // [-], of the way
    const double position = std::min(6e-3, 1e-5 * i) - out * force / 80;
    press.look({.at = 1e-3 * i,
                .felt = out * force,
                .truth = kTissue * position,
                .position = position,
                .work = -1.8e-3 * out});
  }
  EXPECT_LT(press.share(), 0.2);
  EXPECT_NEAR(press.permitted(), force / (kTissue * (6e-3 - force / 80)), 1e-3);
}

}  // namespace
}  // namespace palp::judge
