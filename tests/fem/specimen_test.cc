#include "fem/specimen.h"

#include <string>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

Specimen ball(double depth_mm, double radius_mm) {
  Specimen specimen;
  specimen.inclusion.shape = InclusionShape::Ball;
  specimen.inclusion.depth = depth_mm * 1e-3;
  specimen.inclusion.radius = radius_mm * 1e-3;
  return specimen;
}

TEST(SpecimenTest, AcceptsThePaperAndRefusesABallBelowTheBase) {
  EXPECT_TRUE(check(ball(25, 15)));
  EXPECT_TRUE(check(ball(56.7 - 30, 15)));
  const auto refused = check(ball(56.8 - 30, 15));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("block of height 57 mm"), std::string::npos);
}

TEST(SpecimenTest, RefusesWhatHasNoMeaning) {
  EXPECT_FALSE(check(ball(-1, 5)));
  EXPECT_FALSE(check(ball(0, 5)));
  EXPECT_FALSE(check(ball(5, 0)));
  EXPECT_FALSE(check(ball(5, 45)));
  Specimen specimen = ball(10, 5);
  specimen.block.poisson = 0.5;
  const auto refused = check(specimen);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("below 0.5"), std::string::npos);
  specimen.block.poisson = 0.4999;
  EXPECT_TRUE(check(specimen));
  specimen.inclusion.ratio = 0;
  EXPECT_FALSE(check(specimen));
}

TEST(SpecimenTest, TipsBeginAtZeroAndRise) {
  for (const auto shape : {IndenterShape::Sphere, IndenterShape::Paraboloid, IndenterShape::Cone}) {
    const Indenter indenter{.shape = shape};
    EXPECT_EQ(indenter.profile(0), 0);
    EXPECT_LT(indenter.profile(1e-3), indenter.profile(2e-3));
  }
}

}  // namespace
}  // namespace palp::fem
