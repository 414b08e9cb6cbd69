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
  EXPECT_TRUE(std::isnan(pressed(2.1, 0.6).share()));
  EXPECT_TRUE(std::isnan(FirstPress{}.share()));
}

TEST(FirstPressTest, CountsFromARoundTripLater) {
  FirstPress press{{}, 0.5};
  for (int i = 0; i < 3000; ++i) {
    press.look({.at = 1e-3 * i, .felt = i < 2495 ? 0.0 : 0.4, .truth = 0.8});
  }
  EXPECT_NEAR(press.share(), 0.5, 1e-9);
}

TEST(FirstPressTest, OnlyTheFirstCounts) {
  FirstPress press = pressed(1, 0.6);
  press.look({.at = 2.1});
  for (int i = 0; i < 4000; ++i) press.look({.at = 3 + 1e-3 * i, .felt = 0.8, .truth = 0.8});
  EXPECT_TRUE(std::isnan(press.share()));
}

constexpr double kTissue = 500;  // [N/m]

/// A hand that goes 6 mm into a tissue, feels nothing of it, and has given `before` [J] when it
/// met it, and `work` [J] more on its way.
double permitted(const EnergyBound& bound, double work, double before = 0) {
  FirstPress press{bound};
  for (int i = 0; i < 3000; ++i) {
    const double position = std::min(6e-3, 1e-5 * i);
    press.look({.at = 1e-3 * i,
                .truth = kTissue * position,
                .position = position,
                .work = before + (position > 1e-3 ? work : 0)});
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

TEST(FirstPressTest, WhatTheHandGaveInThisContactItMayHaveBack) {
  EXPECT_LT(permitted({.grip = 80, .energy = 0.5e-3}, 0), 0.8);
  EXPECT_EQ(permitted({.grip = 80, .energy = 0.5e-3}, 0.3e-3),
            permitted({.grip = 80, .energy = 0.8e-3}, 0));
}

TEST(FirstPressTest, WhatTheHandGaveBeforeThisContactItMayNot) {
  EXPECT_EQ(permitted({.grip = 80, .energy = 0.5e-3}, 0, 0.3e-3),
            permitted({.grip = 80, .energy = 0.5e-3}, 0));
}

TEST(FirstPressTest, FrictionAndDampingTakeOfTheEnergyOnTheWay) {
  const EnergyBound plain{.grip = 80, .energy = 1e-3};
  EnergyBound rough = plain;
  rough.friction = 0.05;
  EnergyBound viscous = plain;
  viscous.damping = 4;
  // Where the hand gave most last of all, half a second is left to go out.
  const auto force = [](double friction, double damping) {
    double low = 0;
    double high = 2;
    for (int i = 0; i < 60; ++i) {
      const double f = 0.5 * (low + high);
      const double way = f / 80;
      const double rubbed = friction * std::tanh(way / 0.5 / 2e-3) * way;
      (0.5 * f * f / 80 + rubbed + damping * way * way / 0.5 <= 1e-3 ? low : high) = f;
    }
    return low / (kTissue * (6e-3 - low / 80));
  };
  EXPECT_NEAR(permitted(plain, 0), force(0, 0), 1e-6);
  EXPECT_NEAR(permitted(rough, 0), force(0.05, 0), 1e-6);
  EXPECT_NEAR(permitted(viscous, 0), force(0, 4), 1e-6);
  EXPECT_LT(permitted(rough, 0), 0.98 * permitted(plain, 0));
  EXPECT_LT(permitted(viscous, 0), 0.98 * permitted(plain, 0));
}

TEST(FirstPressTest, WhereEnergyPermitsAllNoMoreThanTheTissueCounts) {
  EXPECT_NEAR(permitted({.grip = 900, .energy = 3e-3}, 0), 1, 1e-6);
}

TEST(FirstPressTest, WhereEnergyPermitsAllNoneOfItIsAShareOfTheForce) {
  FirstPress whole{{.grip = 900, .energy = 9e-3}};
  FirstPress part{{.grip = 80, .energy = 1e-3}};
  for (int i = 0; i < 3000; ++i) {
    const FirstPress::Look now{
        .at = 1e-3 * i, .felt = 0.2, .truth = kTissue * 6e-3, .position = 6e-3};
    whole.look(now);
    part.look(now);
  }
  EXPECT_TRUE(std::isnan(whole.given()));
  EXPECT_NEAR(part.given(), 0.2 / std::sqrt(2 * 80 * 1e-3 + 0.2 * 0.2), 1e-3);
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
  EXPECT_NEAR(press.given(), 0.5, 1e-3);
  EXPECT_NEAR(press.permitted(), force / (kTissue * (6e-3 - force / 80)), 1e-3);
}

}  // namespace
}  // namespace palp::judge
