#include "judge/depth_summary.h"

#include <vector>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

DepthEstimate found(double depth) {
  return {.place = {}, .verdict = DepthVerdict::Found, .hash = 0.07, .depth = depth};
}
DepthEstimate none() { return {.place = {}, .verdict = DepthVerdict::None, .hash = 0.059}; }
DepthEstimate invalid() {
  return {.place = {}, .verdict = DepthVerdict::Invalid, .reason = DepthReason::StrokeTooShort};
}

TEST(DepthSummaryTest, NothingSaysNothing) {
  EXPECT_EQ(summarise_depths({}).verdict, DepthVerdict::Invalid);
  const std::vector<DepthEstimate> strokes{invalid(), invalid()};
  EXPECT_EQ(summarise_depths(strokes).verdict, DepthVerdict::Invalid);
  EXPECT_EQ(summarise_depths(strokes).reason, DepthReason::StrokeTooShort);
}

TEST(DepthSummaryTest, MostStrokesDecideAndAnInvalidOneHasNoVoice) {
  const std::vector<DepthEstimate> strokes{found(0.01), none(), invalid(), none(), invalid()};
  EXPECT_EQ(summarise_depths(strokes).verdict, DepthVerdict::None);
  EXPECT_EQ(summarise_depths(strokes).reason, DepthReason::Ok);
  const std::vector<DepthEstimate> tie{found(0.01), none()};
  EXPECT_EQ(summarise_depths(tie).verdict, DepthVerdict::Found);
}

TEST(DepthSummaryTest, TheDepthIsTheMedianSoOneOutlierDoesNotMoveIt) {
  const std::vector<DepthEstimate> strokes{found(0.010), found(0.011), found(0.090)};
  EXPECT_DOUBLE_EQ(summarise_depths(strokes).depth, 0.011);
  const std::vector<DepthEstimate> four{found(0.012), found(0.010), found(0.014), found(0.011)};
  EXPECT_DOUBLE_EQ(summarise_depths(four).depth, 0.0115);
}

DepthEstimate sure(double depth, double stddev) {
  DepthEstimate out = found(depth);
  out.depth_stddev = stddev;
  out.depth_low = depth - 2 * stddev;
  out.depth_high = depth + 2 * stddev;
  return out;
}

TEST(DepthSummaryTest, StrokesWithErrorBarsAreAddedUpAlreadyAndTheLastSpeaks) {
  const std::vector<DepthEstimate> strokes{
      none(), sure(0.010, 1e-3), sure(0.012, 0.5e-3), invalid()};
  const DepthEstimate summary = summarise_depths(strokes);
  EXPECT_EQ(summary.verdict, DepthVerdict::Found);
  EXPECT_DOUBLE_EQ(summary.depth, 0.012);
  EXPECT_DOUBLE_EQ(summary.depth_low, 0.011);
  EXPECT_DOUBLE_EQ(summary.depth_high, 0.013);
  EXPECT_DOUBLE_EQ(summary.depth_stddev, 0.5e-3);
}

TEST(DepthSummaryTest, WhatIsExcludedIsKept) {
  DepthEstimate excluding = none();
  excluding.depth_low = 0.012;
  const std::vector<DepthEstimate> strokes{sure(0.02, 4e-3), excluding};
  EXPECT_EQ(summarise_depths(strokes).verdict, DepthVerdict::None);
  EXPECT_DOUBLE_EQ(summarise_depths(strokes).depth_low, 0.012);
}

}  // namespace
}  // namespace palp::judge
