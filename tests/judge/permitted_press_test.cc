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

TEST(PermittedPressTest, WithoutAContactItSaysNothing) {
  EXPECT_TRUE(std::isnan(PermittedPress{{.grip = 80, .energy = 1e-3}}.permitted(2)));
}

}  // namespace
}  // namespace palp::judge
