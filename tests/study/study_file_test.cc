#include "study/study_file.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(StudyFileTest, DefaultsAreTheDesigns) {
  const Study study = *parse_study("condition { name: \"one\" }", "file");
  EXPECT_EQ(study.participants, 16U);
  EXPECT_EQ(study.trials, 60U);
  EXPECT_EQ(study.levels.size(), 25U);
  EXPECT_DOUBLE_EQ(study.levels.front(), 0.02);
  EXPECT_NEAR(study.levels.back(), 1.2, 1e-12);
  EXPECT_EQ(study.method.kind, MethodKind::QuestPlus);
  EXPECT_EQ(study.conditions.at(0).coupling, "mmt");
  EXPECT_TRUE(study.conditions.at(0).force);
}

TEST(StudyFileTest, ATwoSidedTaskHasLevelsOfBothSigns) {
  const Study study = *parse_study(
      "task: \"bias\" levels { count: 5 to_ln: 0.4 } condition { name: \"one\" }", "f");
  ASSERT_EQ(study.levels.size(), 5U);
  EXPECT_DOUBLE_EQ(study.levels.front(), -0.4);
  EXPECT_NEAR(study.levels[2], 0, 1e-15);
  EXPECT_NEAR(study.levels.back(), 0.4, 1e-15);
}

TEST(StudyFileTest, WhatCannotBeIsRefusedInOneSentence) {
  const std::string one = "condition { name: \"one\" } ";
  for (const std::string& text : {std::string{},
                                  one + one,
                                  one + "name: \"../out\"",
                                  one + "levels { from_ln: 0 }",
                                  one + "levels { from_ln: 1 to_ln: 0.5 }",
                                  one + "practice { right: 9 of: 8 }",
                                  one + "task: \"bias\" method: \"staircase\"",
                                  one + "task: \"bias\" intervals: 3",
                                  one + "intervals: 1",
                                  one + "tracks: 4 trials: 3",
                                  one + "seed: -1",
                                  one + "colour: \"red\"",
                                  one + "condition { name: \"a\\nb\" }"}) {
    const auto study = parse_study(text, "file");
    ASSERT_FALSE(study) << text;
    EXPECT_EQ(study.error().text.find("file"), 0U) << study.error().text;
    EXPECT_EQ(study.error().text.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace palp::study
