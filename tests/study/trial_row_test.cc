#include "study/trial_row.h"

#include <gtest/gtest.h>

namespace palp::study {
namespace {

TrialRow a_row() {
  return {.ask = {.kind = TrialKind::Catch, .number = 6, .track = 1, .level = 0.25, .stronger = 1},
          .outcome = {.chosen = 1,
                      .onset = 12.5,
                      .duration = 11.25,
                      .response_time = 0.75,
                      .taps = 6,
                      .force_max = 0.5,
                      .contact = 1.5},
          .condition = "B",
          .block = 2,
          .kind = "simulated",
          .believed_mean = -2,
          .believed_sd = 0.25};
}

TEST(TrialRowTest, ComesBackAsItWasWritten) {
  const std::string text = row_header({}) + row_text(a_row());
  const auto file = parse_rows(text, "f", {});
  ASSERT_TRUE(file) << file.error().text;
  ASSERT_EQ(file->rows.size(), 1U);
  EXPECT_EQ(row_text(file->rows[0]), row_text(a_row()));
  EXPECT_EQ(file->whole, text.size());
  EXPECT_EQ(file->rows[0].ask.number, 6U);
  EXPECT_TRUE(file->rows[0].yes());
}

TEST(TrialRowTest, RightMeansTheSideItWasOnAndYesTheSecondWhereLevelsHaveSigns) {
  TrialRow row = a_row();
  row.outcome.chosen = 0;
  EXPECT_FALSE(row.yes());
  row.ask.stronger = 0;
  EXPECT_TRUE(row.yes());
  row.task.two_sided = true;
  EXPECT_FALSE(row.yes());
}

// Wherever a program dies, what is left of its file is read: whole lines only.
TEST(TrialRowTest, ALineThatWasNeverFinishedIsLeftOut) {
  const std::string whole = row_header({}) + row_text(a_row());
  const std::string text = whole + row_text(a_row());
  for (std::size_t length = whole.size(); length < text.size(); ++length) {
    const auto file = parse_rows(std::string_view{text}.substr(0, length), "f", {});
    ASSERT_TRUE(file) << length;
    EXPECT_EQ(file->rows.size(), 1U);
    EXPECT_EQ(file->whole, whole.size());
  }
  EXPECT_EQ(parse_rows("onse", "f", {})->whole, 0U);
}

TEST(TrialRowTest, AnIntervalThatTheTrialDoesNotHaveIsRefused) {
  TrialRow row = a_row();
  row.ask.stronger = row.outcome.chosen = 2;
  const std::string text = row_header({}) + row_text(row);
  EXPECT_FALSE(parse_rows(text, "f", {}));
  const auto file = parse_rows(text, "f", {.task = {.intervals = 3}});
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_EQ(row_text(file->rows.at(0)), row_text(row));
}

TEST(TrialRowTest, AnotherTableOrAChangedAnswerIsRefused) {
  EXPECT_FALSE(parse_rows("level_ln\tcorrect\n", "f", {}));
  std::string text = row_header({}) + row_text(a_row());
  const std::size_t at = text.find("\t1\t-2\t");
  ASSERT_NE(at, std::string::npos);
  text[at + 1] = '0';  // correct
  const auto file = parse_rows(text, "f", {});
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text.find("line 2"), std::string::npos);
  EXPECT_FALSE(parse_rows(row_header({}) + "1\t2\n", "f", {}));
}

}  // namespace
}  // namespace palp::study
