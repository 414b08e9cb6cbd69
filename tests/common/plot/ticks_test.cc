#include "common/plot/ticks.h"

#include <gtest/gtest.h>

namespace palp::plot {
namespace {

TEST(TicksTest, AreRoundAndCoverTheRange) {
  const auto ticks = round_ticks(0.0594, 0.0921, 5);
  EXPECT_LE(ticks.front(), 0.0594);
  EXPECT_GE(ticks.back(), 0.0921);
  EXPECT_GE(ticks.size(), 4U);
  EXPECT_LE(ticks.size(), 9U);
  EXPECT_NEAR(ticks[1] - ticks[0], 0.01, 1e-12);
  EXPECT_EQ(round_ticks(0, 4, 5).back(), 4);
}

TEST(TicksTest, DecadesHaveThreeEachAndKeepTheirEnds) {
  EXPECT_EQ(decade_ticks(1, 10), (std::vector<double>{1, 2, 5, 10}));
  EXPECT_EQ(decade_ticks(3, 40), (std::vector<double>{5, 10, 20}));
  EXPECT_EQ(power_ticks(1, 1000), (std::vector<double>{1, 10, 100, 1000}));
}

TEST(TicksTest, NumbersAreShortAndHaveATrueMinusSign) {
  EXPECT_EQ(tick_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(tick_text(-2), "\u22122");
  EXPECT_EQ(tick_text(-0.0), "0");
}

}  // namespace
}  // namespace palp::plot
