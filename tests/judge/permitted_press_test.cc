#include "judge/permitted_press.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

// What is permitted is tested in first_press_test.cc; here only what comes of several contacts.

TEST(PermittedPressTest, AContactKnowsNothingOfTheOneBefore) {
  const auto pressed = [](PermittedPress& press, double stiffness) {
    press.begin({});
    for (int i = 0; i < 100; ++i) {
      const double position = 5e-5 * i;
      press.look({.at = 1e-3 * i, .truth = stiffness * position, .position = position});
    }
    return press.permitted({.at = 2, .truth = stiffness * 99 * 5e-5, .position = 99 * 5e-5}).share;
  };
  const EnergyBound bound{.grip = 80, .energy = 0.5e-3};
  PermittedPress fresh{bound};
  PermittedPress used{bound};
  const double stiff = pressed(used, 2000);
  EXPECT_LT(stiff, 0.5);
  EXPECT_EQ(pressed(used, 300), pressed(fresh, 300));
}

/// What relaxes under a hand that stays asks for less than it did on the way in.
TEST(PermittedPressTest, TissueThatRelaxedIsGivenWholeWhereTheEnergyPermitsIt) {
  PermittedPress press{{.grip = 900, .energy = 1e-3}};
  press.begin({});
  for (int i = 0; i < 3000; ++i) {
    const double position = std::min(2e-3, 1e-5 * i);
    const double kept = 0.6 + 0.4 * std::exp(-1e-3 * i);
    press.look({.at = 1e-3 * i,
                .felt = 300 * position * kept,
                .truth = 300 * position * kept,
                .position = position});
  }
  const double force = 300 * 2e-3 * (0.6 + 0.4 * std::exp(-2.999));
  EXPECT_NEAR(
      press.permitted({.at = 3, .felt = force, .truth = force, .position = 2e-3}).share, 1, 1e-9);
}

/// A hand that goes on inwards while the force comes in is pushed out along another line.
TEST(PermittedPressTest, WhatAHandGoesOnInwardsAsksForMore) {
  const auto permitted = [](double later) {
    PermittedPress press{{.grip = 80, .energy = 0.3e-3}};
    press.begin({});
    for (int i = 0; i < 100; ++i) {
      const double position = 5e-5 * i;
      press.look({.at = 1e-3 * i, .truth = 300 * position, .position = position});
    }
    const double position = 99 * 5e-5 + later;
    return press.permitted({.at = 2, .truth = 300 * position, .position = position}).share;
  };
  EXPECT_LT(permitted(0), 1);
  EXPECT_LT(permitted(1e-3), permitted(0));
}

TEST(PermittedPressTest, WithoutAContactItSaysNothing) {
  EXPECT_TRUE(std::isnan(PermittedPress{{.grip = 80, .energy = 1e-3}}.permitted({.at = 2}).share));
}

}  // namespace
}  // namespace palp::judge
