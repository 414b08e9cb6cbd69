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
  EXPECT_EQ(study.conditions.at(0).feedback, Feedback::Force);
}

TEST(StudyFileTest, AFeedbackIsGivenDrawnBothOrNone) {
  const std::string depths =
      "task: \"detect2\" depth { top_mm: 5 contrast_ln: 0.4 } depth { top_mm: 9 contrast_ln: 0.2 } "
      "ball { radius_mm: 6 ratio: 50 } ";
  for (const auto& [name, feedback] : {std::pair{"force", Feedback::Force},
                                       {"none", Feedback::None},
                                       {"drawn", Feedback::Drawn},
                                       {"both", Feedback::Both},
                                       {"depth", Feedback::Depth}}) {
    const auto study =
        parse_study(depths + "condition { name: \"one\" feedback: \"" + name + "\" }", "file");
    ASSERT_TRUE(study) << study.error().text;
    EXPECT_EQ(study->conditions.at(0).feedback, feedback);
    EXPECT_DOUBLE_EQ(study->ball->radius, 6e-3);
    EXPECT_DOUBLE_EQ(study->ball->ratio, 50);
  }
  EXPECT_FALSE(gives_force(Feedback::Drawn));
  EXPECT_TRUE(gives_force(Feedback::Both) && draws_force(Feedback::Both));
}

TEST(StudyFileTest, ATwoSidedTaskHasLevelsOfBothSigns) {
  const Study study = *parse_study(
      "task: \"bias\" levels { count: 5 to_ln: 0.4 } condition { name: \"one\" }", "f");
  ASSERT_EQ(study.levels.size(), 5U);
  EXPECT_DOUBLE_EQ(study.levels.front(), -0.4);
  EXPECT_NEAR(study.levels[2], 0, 1e-15);
  EXPECT_NEAR(study.levels.back(), 0.4, 1e-15);
}

const std::string kBalls =
    "ball { radius_mm: 8 ratio: 100 } depth { top_mm: 5 contrast_ln: 0.42 } depth { top_mm: 10 "
    "contrast_ln: 0.13 } depth { top_mm: 20 contrast_ln: 0.02 } ";

TEST(StudyFileTest, ADelayIsAskedForInMilliseconds) {
  const Study study = *parse_study(
      "task: \"delay\" method: \"staircase\" delays { from_ms: 10 to_ms: 160 count: 5 } condition "
      "{ "
      "name: \"one\" }",
      "f");
  ASSERT_EQ(study.levels.size(), 5U);
  EXPECT_NEAR(study.levels[1], 20, 1e-9);
  EXPECT_EQ(study.practice.level, 150);
  EXPECT_EQ(study.task.intervals, 2);
  EXPECT_GT(study.method.staircase.start, 100) << "ms, as the levels are";
}

TEST(StudyFileTest, ASearchIsChanceByTheAreaThatCountsAsFound) {
  const Study study = *parse_study(
      "task: \"locate\" search { side_mm: 50 } condition { name: \"one\" } " + kBalls, "f");
  EXPECT_DOUBLE_EQ(study.search.within, 8e-3) << "the ball's radius";
  EXPECT_NEAR(study.task.places, 2500 / (3.14159265 * 64), 1e-6);
  EXPECT_EQ(study.travel, 4);
  EXPECT_EQ(study.levels.size(), 3U);
}

// Three balls, evenly about the middle of the contrasts: the steps end where the depths do.
TEST(StudyFileTest, ARankingOfBallsStaysWithinItsDepths) {
  const Study study = *parse_study("task: \"rank\" condition { name: \"one\" } " + kBalls, "f");
  EXPECT_EQ(study.task.intervals, 3);
  EXPECT_NEAR(study.levels.back(), 0.2, 1e-12);
  EXPECT_NEAR(middle_contrast(study), 0.22, 1e-12);
  EXPECT_NEAR(*depth_found(study, 0.199), 5e-3, 0.05e-3);
  EXPECT_LT(*depth_found(study, 0.1), *depth_found(study, 0.05));
}

TEST(StudyFileTest, WhatCannotBeIsRefusedInOneSentence) {
  const std::string one = "condition { name: \"one\" } ";
  for (const std::string& text :
       {std::string{},
        one + one,
        one + "name: \"../out\"",
        one + "levels { from_ln: 0 }",
        one + "levels { from_ln: 1 to_ln: 0.5 }",
        one + "practice { right: 9 of: 8 }",
        one + "practice { right: 8 of: 10 trials_max: 7 }",
        one + "task: \"bias\" method: \"staircase\"",
        one + "task: \"bias\" intervals: 3",
        std::string{"condition { name: \"one\" taps: 1 taps_unjudged: 1 }"},
        one + "ball { radius_mm: 8 }",
        std::string{"condition { name: \"one\" feedback: \"depth\" }"},
        one + "intervals: 1",
        one + "tracks: 4 trials: 3",
        one + "seed: -1",
        one + "task: \"rank\" intervals: 2",
        one + "task: \"rank\" levels { to_ln: 0.3 } " + kBalls,
        one + "task: \"rank\" depth { top_mm: 5 contrast_ln: 0.4 } depth { top_mm: 9 contrast_ln: "
              "0.2 }",
        one + "task: \"locate\"",
        one + "task: \"locate\" search { side_mm: 10 within_mm: 9 } " + kBalls,
        one + "search { side_mm: 30 }",
        one + "delays { from_ms: 5 }",
        one + "task: \"delay\" delays { from_ms: 50 to_ms: 20 }",
        std::string{"task: \"delay\" condition { name: \"one\" feedback: \"drawn\" }"},
        one + "task: \"delay\" travel_s: 0.7",
        std::string{"task: \"delay\" condition { name: \"one\" up { delay_ms: 250 } }"},
        one + "task: \"locate\" search { within_mm: 0.1 } " + kBalls,
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
