#include "judge/metric_table.h"

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

}  // namespace
}  // namespace palp::judge
