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
    return press.permitted(2);
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
  EXPECT_NEAR(press.permitted(3), 1, 1e-9);
}

TEST(PermittedPressTest, WithoutAContactItSaysNothing) {
  EXPECT_TRUE(std::isnan(PermittedPress{{.grip = 80, .energy = 1e-3}}.permitted(2)));
}

}  // namespace
}  // namespace palp::judge
