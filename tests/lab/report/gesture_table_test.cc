#include "lab/report/gesture_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "judge/metric_table.h"
#include "lab/report/batch_report.h"
#include "tests/lab/empty_cases.h"

namespace palp::lab {
namespace {

using testing::HasSubstr;
using testing::Not;

void set(CaseResult& result, std::string_view metric, double value) {
  result.values[*judge::metric_index(metric)] = value;
}

TEST(GestureTableTest, HasARowForEachGestureAndRoundTripAndAColumnForEachGrip) {
  const Plan plan = make_set("gestures", {}).value();
  auto results = empty_cases(plan);
  set(results[0], "tap1_a_error", -0.0312);
  set(results[1], "tap1_a_error", 0.214);
  results[1].unstable = true;
  set(results[4], "tap2_a_error", 0.001);
  set(results[20], "share_2s", 0.58);
  set(results[20], "share_permitted", 0.98);
  set(results.back(), "drag_shift_s", 0.314);
  const std::string table = gesture_table(plan, results);
  EXPECT_THAT(table, HasSubstr("| gesture | round trip ms | light | mid | firm | arm |\n"));
  EXPECT_THAT(table, HasSubstr("| first tap of a place | 0 | -3.1 % | +21 % ! | - | - |\n"));
  EXPECT_THAT(table, HasSubstr("| second tap | 20 | +0.1 % | - | - | - |\n"));
  EXPECT_THAT(table, HasSubstr("| first press of a place, held | 0 | -42 % | - | - | - |\n"));
  EXPECT_THAT(table, HasSubstr("| the same, as the energy permits | 0 | -2.0 % | - | - | - |\n"));
  EXPECT_THAT(table, HasSubstr("| the same, later than at the tip | 500 | - | - | - | 0.31 s |\n"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2 + 11 * 5);
}

TEST(GestureTableTest, StandsInTheSummaryOfItsSetAlone) {
  const Plan plan = make_set("gestures", {}).value();
  EXPECT_THAT(batch_summary(plan, empty_cases(plan), {}), HasSubstr("| second tap | 20 |"));
  const Plan other = make_set("table", {}).value();
  EXPECT_THAT(batch_summary(other, empty_cases(other), {}), Not(HasSubstr("| second tap")));
}

TEST(GestureTableTest, AShardHasTheRowsOfItsCases) {
  Plan plan = make_set("gestures", {}).value();
  keep_shard(plan, {.part = 3, .count = 100});
  const std::string table = gesture_table(plan, empty_cases(plan));
  EXPECT_THAT(table, HasSubstr("| first tap of a place | 0 | | | | - |\n"));
}

}  // namespace
}  // namespace palp::lab
