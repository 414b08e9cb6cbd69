#include "study/answers_file.h"

#include <gtest/gtest.h>

namespace palp::study {
namespace {

constexpr std::string_view kFile =
    "onset\ttrial_type\tcondition\tlevel_ln\tcorrect\n"
    "1\tpractice\tA\t1\t1\n"
    "2\ttrial\tA\t0.2\t1\n"
    "3\ttrial\tB\t0.2\t0\n"
    "4\ttrial\tA\t0.2\t0\r\n"
    "5\tcatch\tA\t0.9\t1\n"
    "6\ttrial\tB\t0.3\tn/a\n";

TEST(AnswersFileTest, PoolsTheTrialsOfEachConditionWithoutPracticeAndMissingAnswers) {
  const auto found = parse_answers(kFile, "f.tsv");
  ASSERT_TRUE(found) << found.error().text;
  ASSERT_EQ(found->conditions.size(), 2U);
  EXPECT_EQ(found->conditions[0].condition, "A");
  ASSERT_EQ(found->conditions[0].answers.size(), 2U);
  EXPECT_EQ(found->conditions[0].answers[0].trials, 2U);
  EXPECT_EQ(found->conditions[0].answers[0].yes, 1U);
  EXPECT_EQ(found->conditions[0].answers[1].level, 0.9);
  ASSERT_EQ(found->conditions[1].answers.size(), 1U);
  EXPECT_EQ(found->conditions[1].answers[0].yes, 0U);
}

TEST(AnswersFileTest, ReadsAFileWithoutConditionsAndWithAByteOrderMark) {
  const auto found = parse_answers("\xef\xbb\xbflevel_ln\tcorrect\n0.1\t1\n", "f.tsv");
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->conditions.front().condition, "");
}

TEST(AnswersFileTest, KnowsDelaysByTheirColumnAndLeavesRankingsAndSearchesToTheirStudies) {
  const auto delays = parse_answers("level_ms\tcorrect\n40\t1\n", "f.tsv");
  ASSERT_TRUE(delays) << delays.error().text;
  EXPECT_TRUE(delays->delays);
  EXPECT_EQ(delays->conditions.front().answers.front().level, 40);
  EXPECT_FALSE(parse_answers("level_ln\tcorrect\n0.4\t1\n", "f.tsv")->delays);
  for (const char* const column : {"kendall_tau", "error_mm", "level_ms"}) {
    EXPECT_FALSE(parse_answers("level_ln\tcorrect\t" + std::string{column} + "\n0.4\t1\t1\n", "f"))
        << column;
  }
}

TEST(AnswersFileTest, SaysInOneSentenceWhatIsWrongAndWhere) {
  const auto sentence = [](std::string_view text) {
    return parse_answers(text, "f.tsv").error().text;
  };
  EXPECT_EQ(sentence("level_ln,correct\n"),
            "f.tsv has no column 'level_ln' in its first line; columns are separated by tabs");
  EXPECT_EQ(sentence("level_ln\tcorrect\n0,1\t1\n"),
            "f.tsv, line 2: level_ln is \"0,1\", expected a number");
  EXPECT_EQ(sentence("level_ln\tcorrect\n0.1\tyes\n"),
            "f.tsv, line 2: correct is \"yes\", expected 0, 1 or n/a");
  EXPECT_EQ(sentence("level_ln\tcorrect\n-10.5\t1\n"),
            "f.tsv, line 2: level_ln is -10.5, expected no more than 10 of either sign");
  EXPECT_TRUE(parse_answers("level_ms\tcorrect\n200\t1\n", "f.tsv"));
  EXPECT_EQ(sentence("level_ln\tcorrect\n\n0.1\n"), "f.tsv, line 3 has 1 cells, expected 2");
  EXPECT_EQ(sentence("level_ln\tcorrect\tcorrect\n"), "f.tsv names the column 'correct' twice");
  EXPECT_EQ(sentence("level_ln\tcorrect\n"), "f.tsv holds no answered trial");
}

}  // namespace
}  // namespace palp::study
