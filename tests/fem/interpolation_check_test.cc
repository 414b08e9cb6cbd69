#include "fem/interpolation_check.h"

#include <gtest/gtest.h>

#include "depth/embedded_database.h"

namespace palp::fem {
namespace {

TEST(InterpolationCheckTest, BetweenTheGridsPointsItIsWithinThreeThousandths) {
  auto table = parse_table(depth::embedded_database());
  ASSERT_TRUE(table);
  ASSERT_TRUE(check_interpolation(*table, 3, 11, Accuracy::Coarse));
  EXPECT_EQ(table->checked_count, 3U);
  EXPECT_GT(table->checked_max, 0);
  EXPECT_LE(table->checked_rms, table->checked_max);
  EXPECT_LT(table->checked_max, 0.003);
}

}  // namespace
}  // namespace palp::fem
