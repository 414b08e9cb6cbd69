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

using test::find_excursions;
using test::hand_motion;

TEST(ExcursionsTest, FindsEachTapOnceAndEndsItsLoadingAtTheDeepestTick) {
  const auto motion = hand_motion(2);
  const auto excursions = find_excursions(motion, kSurface);
  ASSERT_EQ(excursions.size(), 4u);
  EXPECT_EQ(excursions[1].place, kSiteA);
  EXPECT_EQ(excursions[2].place, kSiteB);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(excursions[k].deepest_at, test::at_ms(static_cast<std::int64_t>(k) * 1000 + 400));
  }
}

TEST(ExcursionsTest, ContactIsWhereTheSurfaceWasPassed) {
  std::vector<Motion> motion;
  for (int ms = 0; ms < 100; ++ms) {
    motion.push_back(tip_at(1e-3 * (0.05 * ms - 1)));  // the surface after 20 ms, 1.5 mm after 50
    motion.back().at = test::at_ms(ms);
  }
  const auto excursions = find_excursions(motion, 0);
  ASSERT_EQ(excursions.size(), 1u);
  EXPECT_EQ(excursions[0].contact_at, test::at_ms(21));
  EXPECT_EQ(excursions[0].began_at, test::at_ms(36)) << "half of what makes a stroke";
  EXPECT_NEAR(excursions[0].indentation_max, 3.95e-3, 1e-12);
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
  const auto tissue = TissueTable::parse(test::kTissueCsv);
  const auto excursions = find_excursions(motion, kSurface, &*tissue);
  ASSERT_EQ(excursions.size(), 2u);
  const FeltStiffness& at_a = excursions[0].stiffness;
  const FeltStiffness& at_b = excursions[1].stiffness;
  EXPECT_NEAR(*at_a.felt(), test::kFeltA, 1e-6);
  EXPECT_NEAR(*at_a.truth(), 100, 1e-6);
  EXPECT_NEAR(*at_b.felt(), test::kFeltB, 1e-6);
  EXPECT_NEAR(*at_b.truth(), 200, 1e-6);
  EXPECT_FALSE(find_excursions(motion, kSurface).front().stiffness.truth());
}

TEST(ExcursionsTest, TableThatEndsInsideTheWindowGivesNoTruth) {
  const auto motion = hand_motion(1);
  const auto tissue = TissueTable::parse("site,d_mm,F_N\nA,0,0\nA,3,0.3\n");
  const auto stiffness = find_excursions(motion, kSurface, &*tissue).front().stiffness;
  EXPECT_TRUE(stiffness.felt());
  EXPECT_FALSE(stiffness.truth());
}

TEST(ExcursionsTest, WhatGoesInForMinutesIsAnExcursionWithoutAStiffness) {
  // A file that nobody of ours wrote: what is held of a stroke has a bound.
  ExcursionFinder finder{0, nullptr};
  Motion motion = tip_at(2e-3);
  motion.velocity = 1e-6;
  for (int i = 0; i < 300'000; ++i) {
    motion.position += 1e-9;
    EXPECT_FALSE(finder.look(motion));
  }
  const auto found = finder.finish();
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->stiffness.felt());
}

}  // namespace
}  // namespace palp::judge
