// Goal: what an estimate says is what it claims, no more. Method: each verdict, rounded values.
#include "common/core/depth_text.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(DepthTextTest, AFoundInclusionComesWithItsInterval) {
  EXPECT_EQ(
      depth_text(
          {.verdict = DepthVerdict::Found, .depth = 11.8e-3, .low = 11.1e-3, .high = 12.6e-3}),
      "11.8 mm, between 11.1 and 12.6");
}

TEST(DepthTextTest, AnEstimatorWithoutErrorBarsClaimsNone) {
  EXPECT_EQ(
      depth_text({.verdict = DepthVerdict::Found, .depth = 10e-3, .low = 10e-3, .high = 10e-3}),
      "10.0 mm");
}

TEST(DepthTextTest, WhatIsExcludedIsRoundedToTheSafeSide) {
  EXPECT_EQ(depth_text({.verdict = DepthVerdict::None, .low = 12.9e-3}),
            "no inclusion of radius >= 5 mm above 12 mm");
  EXPECT_EQ(depth_text({.verdict = DepthVerdict::None}), "no inclusion");
}

TEST(DepthTextTest, NoStatementSaysWhy) {
  EXPECT_EQ(depth_text({.verdict = DepthVerdict::Invalid, .reason = DepthReason::ForceSaturated}),
            "? (force saturated)");
}

}  // namespace
}  // namespace palp
