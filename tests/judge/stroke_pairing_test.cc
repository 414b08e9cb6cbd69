#include "judge/stroke_pairing.h"

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

Stay stay(double from, double to, const Place& place = kSiteA) {
  return {TimePoint{from_seconds(from)}, TimePoint{from_seconds(to)}, place};
}

TEST(StrokePairingTest, AStrokeBelongsToTheStayThatSharesMostTimeWithIt) {
  const std::vector<Stay> stays{stay(0, 1), stay(1.5, 2.5), stay(3, 4)};
  EXPECT_EQ(partner_of(stay(1.6, 2), stays), 1U);
  EXPECT_EQ(partner_of(stay(0.9, 2), stays), 1U);
  EXPECT_EQ(partner_of(stay(0.4, 1.6), stays), 0U);
  EXPECT_EQ(partner_of(stay(1.1, 1.4), stays), std::nullopt) << "between two";
  EXPECT_EQ(partner_of(stay(4, 5), stays), std::nullopt) << "a border is no time";
  EXPECT_EQ(partner_of(stay(1.6, 2, kSiteB), stays), std::nullopt) << "at another place";
  EXPECT_EQ(partner_of(stay(1.6, 2), {}), std::nullopt);
}

TEST(StrokePairingTest, ATapGetsTheLongestOfItsStrokesAndAPressNone) {
  std::vector<TapMetrics> taps(2);
  taps[0].began_at = 0;
  taps[0].ended_at = 1;
  taps[1].began_at = 2;
  taps[1].ended_at = 3;
  const std::vector<Stay> strokes{stay(0.1, 0.2), stay(0.3, 0.8), stay(5, 6)};
  const std::vector<DepthEstimate> estimates(3);
  const auto found = estimates_of(taps, strokes, estimates);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], &estimates[1]);
  EXPECT_EQ(found[1], nullptr) << "nobody saw its stroke";
}

}  // namespace
}  // namespace palp::judge
