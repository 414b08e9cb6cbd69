// Goal: what a person would still tell apart is computed as published experiments score it.
// Method: closed values of the observer, and cases made by hand.

#include "lab/plan/observer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "judge/metric_table.h"

namespace palp::lab {
namespace {

CaseResult felt(double ratio_true, double ratio_error, const std::string& link) {
  CaseResult result;
  result.labels = {"500", link};
  for (const judge::Metric& metric : judge::metric_table()) {
    double value = 0;
    if (metric.name == "ratio_true") value = ratio_true;
    if (metric.name == "ratio_error") value = ratio_error;
    result.values.push_back(value);
  }
  return result;
}

TEST(ObserverTest, IsRightThreeTimesInFourAtItsWeberFraction) {
  for (const double weber : {0.08, 0.15, 0.22}) {
    EXPECT_NEAR(right_answers(1 + weber, weber), 0.75, 1e-4);
    EXPECT_NEAR(right_answers(1 / (1 + weber), weber), 0.25, 1e-4);
    EXPECT_EQ(right_answers(1, weber), 0.5);
    EXPECT_EQ(right_answers(std::nan(""), weber), 0.5);
    EXPECT_EQ(right_answers(-2, weber), 0.5);
  }
}

TEST(ObserverTest, LosesNothingWhereTheRatioIsRightAndMostWhereNothingIsFelt) {
  Plan plan;
  plan.label_names = {"rtt_ms", "loss"};
  const auto rows =
      observe({felt(1.15, 0, "0"), felt(1.15, 1 / 1.15 - 1, "0.05"), felt(1.15, 0, "0.05")});
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(worst_loss(plan, rows, {{"loss", "0"}}), 0);
  // Of two seeds one is a guess: half of what lies between guessing and 75 % at a fraction of 15 %.
  EXPECT_NEAR(rows[4].loss(), (0.75 - 0.5) / 2, 1e-4);
  EXPECT_EQ(rows[4].weber, 0.15);
  EXPECT_GT(worst_loss(plan, rows, {{"rtt_ms", "500"}, {"loss", "0.05"}}), 0.124);
  EXPECT_TRUE(std::isnan(worst_loss(plan, rows, {{"rtt_ms", "100"}})));
}

}  // namespace
}  // namespace palp::lab
