#include "judge/metric_table.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

TEST(MetricTableTest, EveryNameIsFoundAtItsPlaceAndOnce) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < metric_table().size(); ++i) {
    EXPECT_EQ(metric_index(metric_table()[i].name), i);
    EXPECT_TRUE(names.insert(metric_table()[i].name).second);
  }
  EXPECT_EQ(metric_index("beauty"), std::nullopt);
}

TEST(MetricTableTest, ValuesHaveTheUnitOfTheirName) {
  RunMetrics metrics;
  metrics.drift = 2e-3;
  EXPECT_DOUBLE_EQ(metric_table()[*metric_index("drift_mm")].value(metrics), 2);
}

TEST(MetricTableTest, AFirstPressIsInErrorOnlyWhereAllIsPermitted) {
  RunMetrics metrics;
  const auto value = [&](const char* name) {
    return metric_table()[*metric_index(name)].value(metrics);
  };
  EXPECT_TRUE(std::isnan(value("share_missing")));
  metrics.contact.share_2s = 0.7;
  metrics.contact.share_permitted = 0.9;
  EXPECT_NEAR(value("share_missing"), 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(value("share_error")));
  metrics.contact.share_permitted = 1;
  EXPECT_NEAR(value("share_error"), -0.3, 1e-12);
  metrics.contact.share_2s = 1.2;
  EXPECT_EQ(value("share_missing"), 0);
}

TEST(MetricTableTest, TheTipIsHeldAgainstTheSameHandsFinger) {
  RunMetrics metrics;
  const auto value = [&](const char* name) {
    return metric_table()[*metric_index(name)].value(metrics);
  };
  metrics.contact.force_max = 1.5;
  EXPECT_TRUE(std::isnan(value("tip_force_ratio")));
  EXPECT_TRUE(std::isnan(value("tip_force_excess_n")));
  metrics.contact.force_direct = 1;
  EXPECT_NEAR(value("tip_force_ratio"), 1.5, 1e-12);
  EXPECT_NEAR(value("tip_force_excess_n"), 0.5, 1e-12);
  metrics.contact.force_direct = 2;
  EXPECT_EQ(value("tip_force_excess_n"), 0);
}

TEST(MetricTableTest, ExcessIsBeyondHalfAgainOfAFingersForceAndHalfANewton) {
  RunMetrics metrics;
  const auto excess = [&](double direct, double pressed) {
    metrics.contact.force_direct = direct;
    metrics.contact.force_max = pressed;
    return metric_table()[*metric_index("contact_force_excess_n")].value(metrics);
  };
  EXPECT_EQ(excess(0.2, 0.7), 0);
  EXPECT_NEAR(excess(0.2, 0.8), 0.1, 1e-12);
  EXPECT_EQ(excess(2, 3), 0);
  EXPECT_DOUBLE_EQ(excess(2, 3.5), 0.5);
  EXPECT_TRUE(std::isnan(excess(kUndefined, 3)));
}

}  // namespace
}  // namespace palp::judge
