#include "lab/report/depth_picture.h"

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

DepthCase found(double depth_mm, double low_mm, double high_mm) {
  DepthCase one;
  one.inclusion = true;
  one.verdict = DepthVerdict::Found;
  one.depth = depth_mm * 1e-3;
  one.estimate = 0.5e-3 * (low_mm + high_mm);
  one.low = low_mm * 1e-3;
  one.high = high_mm * 1e-3;
  return one;
}

const plot::Curve* curve_of(const plot::Panel& panel, const std::string& name) {
  for (const plot::Curve& curve : panel.curves) {
    if (curve.name == name) return &curve;
  }
  return nullptr;
}

TEST(DepthPictureTest, IntervalsThatMissTheTruthStandApart) {
  const plot::Figure figure =
      depth_figure({.count = 3}, {found(10, 9, 11), found(10, 8, 12), found(10, 11, 12)});
  ASSERT_EQ(figure.panels.size(), 2U);
  const plot::Curve* const hold = curve_of(figure.panels[0], "95 % interval");
  const plot::Curve* const miss = curve_of(figure.panels[0], "interval that misses the truth");
  ASSERT_TRUE(hold != nullptr && miss != nullptr);
  EXPECT_EQ(hold->x.size(), 2U);
  ASSERT_EQ(miss->x.size(), 1U);
  EXPECT_NEAR(miss->low[0], 11, 1e-9);
}

TEST(DepthPictureTest, TheShareThatHoldsTheTruthIsInPercentOfThePriorsPhantoms) {
  DepthCase wide = found(10, 11, 12);
  wide.wide = true;
  const plot::Figure figure =
      depth_figure({.count = 4},
                   {found(10, 9, 11), found(10, 8, 12), found(10, 9, 13), found(10, 11, 12), wide});
  ASSERT_EQ(figure.panels.size(), 2U);
  const plot::Curve& shares = figure.panels[1].curves.front();
  ASSERT_EQ(shares.y.size(), 1U);
  EXPECT_NEAR(shares.y[0], 75, 1e-9);
}

TEST(DepthPictureTest, ListedDepthsHaveATruthEachAndNoShares) {
  const plot::Figure figure =
      depth_figure({.depths = {5e-3, 10e-3}, .repeats = 1}, {found(5, 4, 6)});
  ASSERT_EQ(figure.panels.size(), 1U);
  const plot::Curve* const truth = curve_of(figure.panels[0], "truth");
  ASSERT_NE(truth, nullptr);
  EXPECT_EQ(truth->x.size(), 6U);
}

}  // namespace
}  // namespace palp::lab
