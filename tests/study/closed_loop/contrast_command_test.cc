#include "study/closed_loop/contrast_command.h"

#include <cmath>

#include <gtest/gtest.h>

#include "study/study_file.h"

namespace palp::study {
namespace {

TEST(ContrastCommandTest, FallsWithDepthAndRisesWithRadiusAndRatio) {
  double before = 10;
  for (const double depth : {8e-3, 10e-3, 13e-3, 18e-3}) {
    const double here = *ball_contrast(8e-3, 100, depth, 4e-3);
    EXPECT_LT(here, before);
    EXPECT_GT(here, 0);
    EXPECT_GT(*ball_contrast(11e-3, 100, depth, 4e-3), here);
    EXPECT_LT(*ball_contrast(8e-3, 5, depth, 4e-3), here);
    before = here;
  }
}

TEST(ContrastCommandTest, WhatItPrintsIsAStudysDepths) {
  const auto end = run_contrast({.from_mm = 8, .to_mm = 18, .count = 4});
  ASSERT_EQ(end.code, config::ExitCode::Done) << end.text;
  const auto study =
      parse_study("task: \"detect2\" condition { name: \"one\" } " + end.text, "printed");
  ASSERT_TRUE(study) << study.error().text;
  EXPECT_EQ(study->depths.size(), 4U);
  EXPECT_NEAR(study->depths.front().depth, 18e-3, 1e-9);
}

TEST(ContrastCommandTest, WhatTheDatabaseDoesNotReachIsASentence) {
  EXPECT_EQ(run_contrast({.from_mm = 9, .to_mm = 9}).code, config::ExitCode::BadInput);
  const auto shallow = ball_contrast(8e-3, 100, 5e-3, 4e-3);
  ASSERT_FALSE(shallow) << "its force ends with the solution";
  EXPECT_NE(shallow.error().text.find("forces are known to"), std::string::npos);
  const auto end = run_contrast({.radius_mm = 50, .from_mm = 1, .to_mm = 100});
  EXPECT_EQ(end.code, config::ExitCode::BadInput);
  EXPECT_FALSE(end.text.empty());
}

}  // namespace
}  // namespace palp::study
