#include "lab/plan/set_case.h"

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

TEST(SetCaseTest, ACaseHasALabelOfEachKindAndIsNumbered) {
  Plan plan;
  add_case(plan, 7, {.round_trip = 0.1, .loss = 0.05, .burst_rate = 0.2}, {});
  add_case(plan, 8, {.grip = "firm"}, {});
  ASSERT_EQ(plan.cases.size(), 2U);
  EXPECT_EQ(plan.cases[1].index, 1U);
  EXPECT_EQ(plan.cases[1].seed, 8U);
  for (const Case& one : plan.cases) {
    EXPECT_EQ(one.labels.size(), set_labels().size());
    const auto scenario = make_case(plan, one);
    ASSERT_TRUE(scenario) << scenario.error().text;
  }
  EXPECT_EQ(plan.cases[0].labels[0], "100");
}

TEST(SetCaseTest, NumbersAreTheSameInSettingsAndLabels) {
  EXPECT_EQ(nine_digit_text(0.1), "0.1");
  EXPECT_EQ(nine_digit_text(1.0 / 3), "0.333333333");
}

}  // namespace
}  // namespace palp::lab
