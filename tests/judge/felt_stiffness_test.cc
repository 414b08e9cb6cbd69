#include "judge/felt_stiffness.h"

#include <limits>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

/// `count` ticks between 1.3 and 3.5 mm that move inwards: 50 N/m where there are 40.
FeltStiffness loading(int count) {
  FeltStiffness stiffness;
  for (int k = 0; k < count; ++k) {
    const double x = 1.3e-3 + 2.2e-3 * k / (count - 1);
    stiffness.add(x, 0.01, 50 * x, 40 * x);
  }
  return stiffness;
}

TEST(FeltStiffnessTest, TwentyOneTicksMakeASlopeTwentyDoNot) {
  EXPECT_NEAR(loading(21).felt().value(), 50, 1e-9);
  EXPECT_NEAR(loading(21).truth().value(), 40, 1e-9);
  EXPECT_NEAR(loading(21).error().value(), 0.25, 1e-9);
  EXPECT_FALSE(loading(20).felt());
  EXPECT_FALSE(loading(20).truth());
  EXPECT_FALSE(loading(20).error());
}

TEST(FeltStiffnessTest, TicksThatMoveOutwardsOrLieOutsideTheWindowAreLeftOut) {
  FeltStiffness stiffness = loading(30);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  stiffness.add(2e-3, -0.01, 9, 9);
  stiffness.add(2e-3, 0, 9, 9);
  stiffness.add(FeltStiffness::kFrom, 0.01, 9, 9);
  stiffness.add(FeltStiffness::kTo, 0.01, 9, 9);
  stiffness.add(kNone, 0.01, 9, 9);
  stiffness.add(2e-3, kNone, 9, 9);
  EXPECT_EQ(stiffness.felt(), loading(30).felt());
  EXPECT_EQ(stiffness.truth(), loading(30).truth());
}

TEST(FeltStiffnessTest, OneTickWithoutTruthLeavesNone) {
  FeltStiffness stiffness = loading(30);
  stiffness.add(2e-3, 0.01, 0.1, std::nullopt);
  EXPECT_TRUE(stiffness.felt());
  EXPECT_FALSE(stiffness.truth());
  EXPECT_FALSE(stiffness.error());
}

TEST(FeltStiffnessTest, InTheAirThereIsNothingToErrAbout) {
  FeltStiffness stiffness;
  for (int k = 0; k < 30; ++k) stiffness.add(1.3e-3 + 5e-5 * k, 0.01, 0.1, 0);
  EXPECT_EQ(stiffness.truth(), 0);
  EXPECT_FALSE(stiffness.error());
}

TEST(FeltStiffnessTest, AHandAtOnePositionHasNoSlope) {
  FeltStiffness stiffness;
  for (int k = 0; k < 30; ++k) stiffness.add(2e-3, 0.01, 0.1 * k, 0.1);
  EXPECT_FALSE(stiffness.felt());
}

}  // namespace
}  // namespace palp::judge
