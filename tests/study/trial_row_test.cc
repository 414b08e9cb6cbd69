#include "study/trial_row.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

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

/// The row with another text in one of its cells.
std::string row_with(std::size_t cell, const std::string& text) {
  std::string row = row_text(a_row());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < cell; ++i) begin = row.find('\t', begin) + 1;
  const std::size_t end = row.find_first_of("\t\n", begin);
  return row.replace(begin, end - begin, text);
}

TEST(TrialRowTest, EveryCellIsLookedAt) {
  const auto columns = row_columns({});
  const auto at = [&](std::string_view name) {
    const auto found = std::ranges::find(columns, name, &Column::name);
    return static_cast<std::size_t>(found - columns.begin());
  };
  for (const auto& [name, text] : std::initializer_list<std::pair<const char*, const char*>>{
           {"onset", "-1"},         {"duration", "-0.5"},   {"response_time", "-1"},
           {"trial_type", "Trial"}, {"block", "0"},         {"block", "3"},
           {"block", "2.5"},        {"trial", "0"},         {"trial", "6.5"},
           {"track", "-1"},         {"track", "0.5"},       {"condition", "D"},
           {"condition", ""},       {"condition", "AB"},    {"condition", "=cmd|calc,\"x"},
           {"interval", "1.9"},     {"response", "1.9"},    {"response", "3"},
           {"correct", "0.5"},      {"posterior_sd", "-1"}, {"taps", "-3"},
           {"taps", "2.5"},         {"force_max_n", "-1"},  {"contact_s", "-1"},
           {"kind", "robot"},       {"kind", ""},           {"level_ln", "nan"}}) {
    const auto file =
        parse_rows(row_header({}) + row_with(at(name), text), "f", {.conditions = 3, .block = 2});
    ASSERT_FALSE(file) << name << ' ' << text;
    EXPECT_NE(file.error().text.find(std::string{"line 2: "} + name), std::string::npos)
        << file.error().text;
  }
  EXPECT_TRUE(parse_rows(
      row_header({}) + row_with(at("posterior_mean"), "-1"), "f", {.conditions = 3, .block = 2}));
  EXPECT_FALSE(parse_rows(row_header({}) + row_text(a_row()), "f", {.block = 1}));
}

TEST(TrialRowTest, AFileThatIsNoneOfThisVersionIsNotEmpty) {
  EXPECT_FALSE(parse_rows("answers", "f", {}));
  EXPECT_TRUE(parse_rows("", "f", {}));
  std::string text = row_header({}) + row_text(a_row());
  std::ranges::replace(text, '\n', '\r');
  EXPECT_FALSE(parse_rows(text, "f", {}));
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

TEST(TrialRowTest, EachTaskHasItsColumns) {
  TrialRow rank = a_row();
  rank.task = {.intervals = 3, .ranks = true};
  rank.ask.stronger = 4;
  rank.outcome.chosen = 5;
  TrialRow search = a_row();
  search.task = {.intervals = 1, .places = 8};
  search.ask.stronger = 0;
  search.outcome.chosen = 1;
  search.outcome.error = 12.5e-3;
  search.outcome.path = 0.31;
  search.outcome.force_mean = 0.4;
  TrialRow delay = a_row();
  delay.task.delays = true;
  delay.ask.level = 84.8528137;
  for (const TrialRow& row : {rank, search, delay}) {
    const auto file = parse_rows(row_header(row.task) + row_text(row), "f", {.task = row.task});
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(row_text(file->rows.at(0)), row_text(row));
    EXPECT_FALSE(parse_rows(row_header({}) + row_text(row), "f", {.task = row.task}));
  }
  EXPECT_NE(row_text(rank).find("0.333333333\n"), std::string::npos);
  EXPECT_NE(row_header(delay.task).find("level_ms"), std::string::npos);
  // Found is found within its distance.
  const std::string said = row_header(search.task) + row_text(search);
  EXPECT_TRUE(parse_rows(said, "f", {.task = search.task, .within = 8e-3}));
  EXPECT_FALSE(parse_rows(said, "f", {.task = search.task, .within = 13e-3}));
  // A tau that does not follow from the orders was changed by hand.
  std::string text = row_header(rank.task) + row_text(rank);
  text.replace(text.rfind("0.333333333"), 11, "1");
  EXPECT_FALSE(parse_rows(text, "f", {.task = rank.task}));
}

}  // namespace
}  // namespace palp::study
