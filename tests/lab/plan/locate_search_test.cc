// Goal: each rule palpates a field by its own places and is judged alike. Method: a few searches
// for one ball.
#include "lab/plan/locate_search.h"

#include <array>

#include <gtest/gtest.h>

#include "lab/plan/locate_study.h"

namespace palp::lab {
namespace {

LocateCase searched(TapRule rule, std::uint32_t index = 0) {
  LocateStudy study{.count = 1, .seed = 4, .rule = rule};
  EXPECT_TRUE(take_ball("depth=5 radius=14 ratio=500 at=-6,5", study));
  const auto bench = LocateBench::make(study);
  EXPECT_TRUE(bench);
  return bench->run(index);
}

TEST(LocateSearchTest, ASiteKnowsTheBallAfterFewerTouchesThanARaster) {
  const LocateCase search = searched(TapRule::Search);
  const LocateCase raster = searched(TapRule::Raster);
  for (const LocateCase& one : {search, raster}) {
    EXPECT_TRUE(one.right());
    EXPECT_EQ(one.searched.known, one.searched.touches) << "what is known is touched no more";
    EXPECT_GE(one.searched.known, one.searched.near);
    EXPECT_GT(one.searched.near, 0U);
  }
  EXPECT_LT(2 * search.searched.known, raster.searched.known);
}

TEST(LocateSearchTest, AGaussianProcessFindsThePlace) {
  const LocateCase gp = searched(TapRule::Gp);
  EXPECT_EQ(gp.searched.touches, kFieldTaps);
  EXPECT_GT(gp.searched.known, 3U);
  EXPECT_LT(gp.searched.known, kFieldTaps);
}

TEST(LocateSearchTest, ThePlaceCountsFromWhereItStaysAndWhatIsKnownFromTheFirstTime) {
  Searched one;
  constexpr std::array kNear{false, true, false, true, true};
  for (const bool near : kNear) {
    ++one.touches;
    one.judge(one.touches >= 3, near);
  }
  EXPECT_EQ(one.known, 3U);
  EXPECT_EQ(one.near, 4U);
  one.judge(false, false);
  EXPECT_EQ(one.near, 0U);
}

TEST(LocateSearchTest, PlainTissueIsNeverKnown) {
  const LocateCase plain = searched(TapRule::Search, 1);
  EXPECT_FALSE(plain.found);
  EXPECT_EQ(plain.searched.known, 0U);
  EXPECT_EQ(plain.searched.near, 0U);
}

TEST(LocateSearchTest, TheSameSeedTapsTheSamePlaces) {
  const LocateCase one = searched(TapRule::Search);
  const LocateCase again = searched(TapRule::Search);
  EXPECT_EQ(one.searched.touches, again.searched.touches);
  EXPECT_EQ(one.log_evidence, again.log_evidence);
}

}  // namespace
}  // namespace palp::lab
