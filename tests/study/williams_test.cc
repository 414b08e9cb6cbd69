#include "study/williams.h"

#include <map>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

TEST(WilliamsTest, EachConditionFollowsEachOtherAndStandsAtEachPlaceEquallyOften) {
  for (std::size_t n = 1; n <= 9; ++n) {
    const auto rows = williams_square(n);
    EXPECT_EQ(rows.size(), n % 2 == 1 && n > 1 ? 2 * n : n);
    std::map<std::pair<std::size_t, std::size_t>, int> follows;
    std::map<std::pair<std::size_t, std::size_t>, int> stands;
    for (const auto& row : rows) {
      ASSERT_EQ(row.size(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ++stands[{i, row[i]}];
        if (i > 0) ++follows[{row[i - 1], row[i]}];
      }
    }
    ASSERT_EQ(stands.size(), n * n) << n;
    ASSERT_EQ(follows.size(), n * (n - 1)) << n;
    for (const auto& [pair, times] : stands) EXPECT_EQ(times, stands.begin()->second) << n;
    for (const auto& [pair, times] : follows) EXPECT_EQ(times, follows.begin()->second) << n;
  }
}

}  // namespace
}  // namespace palp::study
