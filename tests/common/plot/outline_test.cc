#include "common/plot/outline.h"

#include <gtest/gtest.h>

namespace palp::plot {
namespace {

TEST(OutlineTest, OfAColumnItKeepsBothEndsAndBothPeaksInTheirOrder) {
  const std::vector<Spot> kept =
      outline({{0, 5}, {0.01, 6}, {0.02, 9}, {0.03, 4}, {0.04, 1}, {0.05, 3}, {0.3, 2}});
  ASSERT_EQ(kept.size(), 5U);
  EXPECT_EQ(kept[0].y, 5);
  EXPECT_EQ(kept[1].y, 9);
  EXPECT_EQ(kept[2].y, 1);
  EXPECT_EQ(kept[3].y, 3);
  EXPECT_EQ(kept[4].y, 2);
}

TEST(OutlineTest, AFewPointsStayAsTheyAre) {
  EXPECT_TRUE(outline({}).empty());
  EXPECT_EQ(outline({{1, 1}}).size(), 1U);
  EXPECT_EQ(outline({{1, 1}, {2, 2}, {1, 3}}).size(), 3U) << "a line may go back";
}

}  // namespace
}  // namespace palp::plot
