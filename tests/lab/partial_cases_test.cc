#include "lab/partial_cases.h"

#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "judge/metric_table.h"
#include "lab/plan/plan.h"
#include "lab/report/batch_report.h"
#include "tests/support/own_path.h"

// Goal: what an interrupted batch has made is not made again, and nothing else is taken for it.

namespace palp::lab {
namespace {

Plan plan_of(std::uint64_t count, std::uint64_t seed = 5) {
  return *make_set("mc", {.count = count, .seed = seed});
}

CaseResult result_for(const Case& one) {
  CaseResult result;
  result.index = one.index;
  result.seed = one.seed;
  result.labels = one.labels;
  result.digest = one.seed * 7;
  result.outcome = "completed";
  result.values.assign(judge::metric_table().size(), 0.25);
  return result;
}

std::string fresh_path() {
  const std::string path = test::own_path("cases.csv");
  remove_partial_rows(path);
  return path;
}

/// Leaves the rows of the first `count` cases and half a line.
void interrupt(const std::string& path, std::uint64_t count) {
  Plan plan = plan_of(4);
  std::vector<CaseResult> before;
  auto kept = PartialCases::begin(path, false, plan, before);
  ASSERT_TRUE(kept) << kept.error().text;
  for (std::uint64_t i = 0; i < count; ++i) kept->add(plan, result_for(plan.cases[i]));
  const auto text = read_whole_file(path + ".partial");
  ASSERT_TRUE(text);
  ASSERT_TRUE(config::write_whole_file(path + ".partial", *text + "3,99"));
}

TEST(PartialCasesTest, OnlyWhatIsMissingIsLeftToDo) {
  const std::string path = fresh_path();
  interrupt(path, 2);
  Plan plan = plan_of(4);
  std::vector<CaseResult> before;
  auto kept = PartialCases::begin(path, true, plan, before);
  ASSERT_TRUE(kept) << kept.error().text;
  ASSERT_EQ(plan.cases.size(), 2U);
  EXPECT_EQ(plan.cases.front().index, 2U);
  ASSERT_EQ(before.size(), 2U);
  for (const Case& one : plan.cases) {
    kept->add(plan, result_for(one));
    before.push_back(result_for(one));
  }
  const auto text = read_whole_file(path + ".partial");
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, cases_csv(plan, before)) << "half a line is gone";
  remove_partial_rows(path);
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(PartialCasesTest, ARowThatWasHalfWrittenIsMadeAgain) {
  const std::string path = fresh_path();
  interrupt(path, 3);
  auto text = *read_whole_file(path + ".partial");
  // The disk was full for a moment in the middle of the second row.
  const std::size_t second = text.find("\n1,") + 1;
  text.erase(second + 40, 30);
  ASSERT_TRUE(config::write_whole_file(path + ".partial", text));
  Plan plan = plan_of(4);
  std::vector<CaseResult> before;
  auto kept = PartialCases::begin(path, true, plan, before);
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_EQ(before.size(), 2U);
  ASSERT_EQ(plan.cases.size(), 2U);
  EXPECT_EQ(plan.cases.front().index, 1U);
  remove_partial_rows(path);
}

TEST(PartialCasesTest, RowsOfAnotherPlanAreRefused) {
  const std::string path = fresh_path();
  interrupt(path, 2);
  for (Plan other : {plan_of(5), plan_of(4, 6)}) {
    std::vector<CaseResult> before;
    EXPECT_FALSE(PartialCases::begin(path, true, other, before));
  }
  remove_partial_rows(path);
}

TEST(PartialCasesTest, WithoutResumeItBeginsAnew) {
  const std::string path = fresh_path();
  interrupt(path, 2);
  Plan plan = plan_of(4);
  std::vector<CaseResult> before;
  EXPECT_TRUE(PartialCases::begin(path, false, plan, before));
  EXPECT_EQ(plan.cases.size(), 4U);
  EXPECT_TRUE(before.empty());
  remove_partial_rows(path);
}

TEST(PartialCasesTest, ToResumeNeedsAFile) {
  Plan plan = plan_of(4);
  std::vector<CaseResult> before;
  EXPECT_FALSE(PartialCases::begin("", true, plan, before));
}

}  // namespace
}  // namespace palp::lab
