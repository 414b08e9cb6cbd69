#include "depth/depth_estimator.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

/// What both estimators say of the same samples.
struct Both {
  std::vector<DepthEstimate> bayes;
  std::vector<DepthEstimate> paper;
};

Both judged(const Tapping& tapping, const SimulatedPhantomConfig& sensor) {
  const auto phantom = make_phantom("paper-10mm");
  EXPECT_TRUE(phantom);
  depth::DepthEstimator bayes{{}};
  depth::DepthEstimator paper{paper_estimator()};
  Both both;
  feel_taps(*phantom, sensor, tapping, {}, [&](const ContactSample& sample) {
    if (const auto estimate = bayes.add(sample)) both.bayes.push_back(*estimate);
    if (const auto estimate = paper.add(sample)) both.paper.push_back(*estimate);
    EXPECT_EQ(bayes.stroke().size(), paper.stroke().size());
  });
  EXPECT_EQ(both.bayes.size(), both.paper.size());
  return both;
}

/// The tracker's words pass through both as they are.
void expect_same_stroke(const DepthEstimate& a, const DepthEstimate& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.stroke_began_at, b.stroke_began_at);
  EXPECT_EQ(a.stroke_ended_at, b.stroke_ended_at);
  EXPECT_EQ(a.place, b.place);
  EXPECT_EQ(a.indentation_max, b.indentation_max);
  EXPECT_EQ(a.force_max, b.force_max);
  EXPECT_EQ(a.surface, b.surface);
  EXPECT_EQ(a.hash, b.hash);
}

TEST(DepthEstimatorTest, BothEstimatorsHearTheSameStrokes) {
  const Both both = judged({.taps = 2, .indentation = 3.8e-3, .rest_time = 0.2}, {});
  ASSERT_EQ(both.bayes.size(), 2U);
  for (std::size_t i = 0; i < both.bayes.size(); ++i) {
    expect_same_stroke(both.bayes[i], both.paper[i]);
    EXPECT_NE(both.bayes[i].verdict, DepthVerdict::Invalid);
    EXPECT_EQ(both.paper[i].depth_stddev, 0);
  }
}

TEST(DepthEstimatorTest, WhatTheTrackerRefusesNobodyJudges) {
  const Both both = judged({.taps = 2, .hesitant = 1}, {.force_noise = 0.15});
  ASSERT_FALSE(both.bayes.empty());
  for (std::size_t i = 0; i < both.bayes.size(); ++i) {
    expect_same_stroke(both.bayes[i], both.paper[i]);
    EXPECT_NE(both.bayes[i].reason, DepthReason::Ok);
    EXPECT_EQ(both.bayes[i].reason, both.paper[i].reason);
    EXPECT_EQ(both.bayes[i].verdict, DepthVerdict::Invalid);
    EXPECT_EQ(both.paper[i].verdict, DepthVerdict::Invalid);
  }
}

/// Each has a length of its own from which it says something.
TEST(DepthEstimatorTest, BayesJudgesStrokesTooShortForTheCubic) {
  const Both both = judged({.taps = 1, .indentation = 2.2e-3}, ideal_sensor());
  ASSERT_EQ(both.bayes.size(), 1U);
  EXPECT_EQ(both.paper[0].reason, DepthReason::StrokeTooShort);
  EXPECT_EQ(both.bayes[0].reason, DepthReason::Ok);
}

}  // namespace
}  // namespace palp::patient
