#include "lab/report/visibility.h"

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

// Deeper inclusions must be larger to be seen, softer ones too; more taps see smaller ones.
TEST(VisibilityTest, WhatIsSeenShrinksWithDepthAndSoftness) {
  const auto database = depth::default_database();
  ASSERT_TRUE(database);
  const auto size = [](double radius) { return radius > 0 ? radius : 1; };  // none: very large
  const Visibility few = visibility(*database, {.taps = 1, .reference_taps = 1}, 5);
  const Visibility many = visibility(*database, {.taps = 16, .reference_taps = 16}, 5);
  const Visibility unsure = visibility(*database, {.taps = 1, .reference_taps = 1}, 1);
  for (std::size_t i = 0; i < few.depths.size(); ++i) {
    for (std::size_t k = 0; k < few.ratios.size(); ++k) {
      EXPECT_LE(many.radii[i][k], size(few.radii[i][k]));
      EXPECT_LE(size(unsure.radii[i][k]), size(few.radii[i][k]));
      if (i > 0) {
        EXPECT_GE(size(few.radii[i][k]), size(few.radii[i - 1][k]));
      }
      if (k > 0) {
        EXPECT_LE(size(few.radii[i][k]), size(few.radii[i][k - 1]) + 0.1e-3);
      }
    }
  }
  EXPECT_LT(unsure.radii[2][3], few.radii[2][3]);
  EXPECT_EQ(many.radii.front().back(), many.radius_min);
  EXPECT_EQ(few.radii.back().front(), 0);
  EXPECT_NE(visibility_text(few).find("none"), std::string::npos);
}

}  // namespace
}  // namespace palp::lab
