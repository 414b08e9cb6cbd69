#include "judge/excursions.h"

#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::judge {
namespace {

Motion tip_at(double position) {
  Motion motion;
  motion.position = position;
  return motion;
}

namespace test = review::test;
using test::kSurface;

std::vector<Motion> hand_motion(int taps_per_place) {
  std::vector<Motion> motion;
  for (std::int64_t ms = 0; ms < 2000 * taps_per_place; ++ms) {
    const auto tick = test::hand_tick(ms, taps_per_place);
    motion.push_back({tick.at, tick.position, tick.velocity, tick.force, tick.place});
  }
  return motion;
}

TEST(ExcursionsTest, FindsEachTapOnceAndEndsItsLoadingAtTheDeepestTick) {
  const auto motion = hand_motion(2);
  const auto excursions = find_excursions(motion, kSurface);
  ASSERT_EQ(excursions.size(), 4u);
  EXPECT_EQ(excursions[1].place, kSiteA);
  EXPECT_EQ(excursions[2].place, kSiteB);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(excursions[k].loading.back().at,
              test::at_ms(static_cast<std::int64_t>(k) * 1000 + 400));
  }
}

TEST(ExcursionsTest, DipJustDeepEnoughCountsAndOneLessDoesNot) {
  const auto dip = [](double depth) {
    return std::vector<Motion>{tip_at(0), tip_at(depth), tip_at(0)};
  };
  EXPECT_EQ(find_excursions(dip(1.5001e-3), 0).size(), 1u);
  EXPECT_EQ(find_excursions(dip(1.4999e-3), 0).size(), 0u);
  EXPECT_EQ(find_excursions(dip(1.5001e-3), 1e-3).size(), 0u) << "the surface lies deeper";
}

TEST(ExcursionsTest, HandStillInsideAtTheEndOfTheFileIsAnExcursion) {
  const std::vector<Motion> motion{tip_at(0), tip_at(2e-3), tip_at(3e-3)};
  EXPECT_EQ(find_excursions(motion, 0).size(), 1u);
  EXPECT_TRUE(find_excursions({}, 0).empty());
}

TEST(ExcursionsTest, SlopesOfLinearForceAndLinearTissueAreExact) {
  const auto motion = hand_motion(1);
  const auto excursions = find_excursions(motion, kSurface);
  const auto tissue = TissueTable::parse(test::kTissueCsv);
  ASSERT_EQ(excursions.size(), 2u);
  const FeltStiffness at_a = stiffness_of(excursions[0], kSurface, &*tissue);
  const FeltStiffness at_b = stiffness_of(excursions[1], kSurface, &*tissue);
  EXPECT_NEAR(*at_a.felt(), test::kFeltA, 1e-6);
  EXPECT_NEAR(*at_a.truth(), 100, 1e-6);
  EXPECT_NEAR(*at_b.felt(), test::kFeltB, 1e-6);
  EXPECT_NEAR(*at_b.truth(), 200, 1e-6);
  EXPECT_FALSE(stiffness_of(excursions[0], kSurface, nullptr).truth());
}

TEST(ExcursionsTest, TableThatEndsInsideTheWindowGivesNoTruth) {
  const auto motion = hand_motion(1);
  const auto tissue = TissueTable::parse("site,d_mm,F_N\nA,0,0\nA,3,0.3\n");
  const auto stiffness =
      stiffness_of(find_excursions(motion, kSurface).front(), kSurface, &*tissue);
  EXPECT_TRUE(stiffness.felt());
  EXPECT_FALSE(stiffness.truth());
}

}  // namespace
}  // namespace palp::judge
