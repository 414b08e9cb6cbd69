#include "depth/paper_hash.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::depth {
namespace {

TEST(PaperHashTest, ReproducesTableOne) {
  // The printed coefficients are rounded: estimated depths within 1 % of the paper's.
  EXPECT_NEAR(depth_of_hash(0.0925485), 5.1039e-3, 0.05e-3);
  EXPECT_NEAR(depth_of_hash(0.0697493), 9.8251e-3, 0.1e-3);
  EXPECT_NEAR(depth_of_hash(0.0654103), 13.2451e-3, 0.14e-3);
}

TEST(PaperHashTest, HasItsMinimumAtFiveMillimetre) {
  double least = 1;
  double at = 0;
  for (double h = kHashMin; h <= kHashMax; h += 1e-5) {
    if (depth_of_hash(h) < least) {
      least = depth_of_hash(h);
      at = h;
    }
  }
  EXPECT_NEAR(least, 5.04e-3, 0.01e-3);
  EXPECT_NEAR(at, 0.090, 0.001);
}

TEST(PaperHashTest, JudgesBothSidesOfItsBorders) {
  EXPECT_EQ(judge_hash(0.06089).verdict, DepthVerdict::None);
  EXPECT_EQ(judge_hash(0.06089).depth, 0);
  EXPECT_EQ(judge_hash(0.0609).verdict, DepthVerdict::Found);
  EXPECT_EQ(judge_hash(0.095).verdict, DepthVerdict::Found);
  EXPECT_EQ(judge_hash(0.09501).verdict, DepthVerdict::Invalid);
  EXPECT_EQ(judge_hash(0.09501).reason, DepthReason::HashOutOfRange);
  EXPECT_EQ(judge_hash(0.0591).verdict, DepthVerdict::None);  // beside the pole
  EXPECT_EQ(judge_hash(std::nan("")).verdict, DepthVerdict::Invalid);
  EXPECT_NEAR(judge_hash(0.06885).depth, 10.3e-3, 0.2e-3);
}

}  // namespace
}  // namespace palp::depth
