#include "study/level_curves.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

Study study_of(const std::string& ball) {
  return *parse_study(
      "task: \"detect2\" depth { top_mm: 5 contrast_ln: 0.42 } depth { top_mm: 10 contrast_ln: "
      "0.13 "
      "} depth { top_mm: 20 contrast_ln: 0.03 } condition { name: \"one\" } " +
          ball,
      "study");
}

TEST(LevelCurvesTest, WithoutABallPlainTissueIsMadeStiffer) {
  const auto curves = LevelCurves::make(study_of(""));
  ASSERT_TRUE(curves);
  const patient::ForceTable plain = patient::make_phantom("none")->plain;
  for (const double depth : {0.5e-3, 2e-3, 5e-3}) {
    EXPECT_DOUBLE_EQ(curves->at(0).force(depth), plain.force(depth));
    for (const double level : {-0.4, 0.13, 0.9}) {
      EXPECT_NEAR(curves->at(level).force(depth), plain.force(depth) * std::exp(level), 1e-9);
    }
  }
}

// The tissue of a ball's depth is that of the phantom with such a ball.
TEST(LevelCurvesTest, ALevelOfABallIsTheTissueAboveIt) {
  const auto curves = LevelCurves::make(study_of("ball { radius_mm: 8 ratio: 100 }"));
  ASSERT_TRUE(curves);
  for (const auto& [level, depth] : {std::pair{0.13, 10e-3}, {0.03, 20e-3}}) {
    const auto phantom = ball_phantom(8e-3, 100, depth);
    ASSERT_TRUE(phantom);
    for (const double press : {1e-3, 3e-3}) {
      EXPECT_NEAR(curves->at(level).force(press), phantom->over.force(press), 1e-9);
      EXPECT_NEAR(curves->at(0).force(press), phantom->plain.force(press), 1e-9);
    }
  }
}

TEST(LevelCurvesTest, WhereABallWasNotSolvedTheForceGoesOnAsSteeply) {
  const auto curves = LevelCurves::make(study_of("ball { radius_mm: 8 ratio: 100 }"));
  const patient::ForceTable shallow = curves->at(0.42);
  const double solved = ball_phantom(8e-3, 100, 5e-3)->over.depth_max();
  ASSERT_LT(solved, 5e-3);
  EXPECT_GT(shallow.force(6e-3), shallow.force(solved) + 0.5 * shallow.derivative(solved) * 1e-3);
  EXPECT_GE(shallow.depth_max(), 8e-3);
}

TEST(LevelCurvesTest, WhatTheDatabaseDoesNotHoldIsASentence) {
  EXPECT_FALSE(LevelCurves::make(study_of("ball { radius_mm: 50 ratio: 100 }")));
}

// A ranking of balls: each level means a depth between those of the file, 0 the middle contrast.
TEST(LevelCurvesTest, ARankingGoesByContrastsAboutTheMiddle) {
  const Study study = *parse_study(
      "task: \"rank\" levels { from_ln: 0.05 to_ln: 0.19 count: 3 } ball { radius_mm: 8 ratio: 100 "
      "} "
      "depth { top_mm: 5 contrast_ln: 0.42 } depth { top_mm: 10 contrast_ln: 0.13 } depth { "
      "top_mm: "
      "20 contrast_ln: 0.03 } condition { name: \"one\" }",
      "study");
  const auto curves = LevelCurves::make(study);
  ASSERT_TRUE(curves) << curves.error().text;
  double before = 0;
  for (const double level : {-0.19, -0.05, 0.0, 0.05, 0.19}) {
    const double force = curves->at(level).force(4e-3);
    EXPECT_GT(force, before) << level;
    before = force;
  }
  EXPECT_GT(curves->at(0).force(4e-3), 1.05 * patient::make_phantom("none")->plain.force(4e-3));
}

TEST(LevelCurvesTest, AHiddenBallLiesWhereItIsPut) {
  const auto curves = LevelCurves::make(study_of("ball { radius_mm: 8 ratio: 100 }"));
  const patient::Phantom phantom = curves->hiding(0.13, {7e-3, -9e-3});
  ASSERT_TRUE(phantom.block);
  EXPECT_EQ(phantom.block->inclusions.front().axis, (Place{7e-3, -9e-3}));
  EXPECT_DOUBLE_EQ(*phantom.depth, 10e-3);
  const auto field = patient::make_field(phantom, 0);
  EXPECT_NEAR(field->elastic_force({7e-3, -9e-3}, 3e-3), curves->at(0.13).force(3e-3), 1e-6);
  EXPECT_LT(field->elastic_force({27e-3, -9e-3}, 3e-3), field->elastic_force({7e-3, -9e-3}, 3e-3));
}

}  // namespace
}  // namespace palp::study
