#include "judge/first_press.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

/// Air for a second, then contact for `seconds`: `share` of the true force is felt.
FirstPress pressed(double seconds, double share) {
  FirstPress press;
  for (int i = 0; i < 1000; ++i) press.look(1e-3 * i, 0, 0);
  for (int i = 0; i < 1000 * seconds; ++i) press.look(1 + 1e-3 * i, 0.8 * share, 0.8);
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
  press.look(2.1, 0, 0);
  for (int i = 0; i < 4000; ++i) press.look(3 + 1e-3 * i, 0.8, 0.8);
  EXPECT_TRUE(std::isnan(press.share()));
}

}  // namespace
}  // namespace palp::judge
