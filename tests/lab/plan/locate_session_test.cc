// Goal: a study of whole sessions finds what the hand palpated. Method: one session of each kind.
#include "lab/plan/locate_session.h"

#include <gtest/gtest.h>

#include "lab/plan/locate_study.h"

namespace palp::lab {
namespace {

LocateCase first_case(LocateStudy study) {
  EXPECT_TRUE(take_ball("depth=5 radius=14 ratio=500 at=-2,5", study));
  const auto bench = LocateBench::make(study);
  EXPECT_TRUE(bench);
  return bench->run(0);
}

TEST(LocateSessionTest, NineTapsOverALinkFindTheBall) {
  const LocateCase one = first_case({.count = 1, .seed = 3, .script = "map", .round_trip = 0.1});
  EXPECT_TRUE(one.right());
  EXPECT_EQ(one.strokes, 9U);
  EXPECT_EQ(one.coordinates[0].truth, -2e-3);
}

/// It ends where one standard deviation is 1 mm, so that some are not right within 1 mm.
TEST(LocateSessionTest, ASearchEndsByItselfAndMostAreRight) {
  constexpr std::uint32_t kBalls = 4;
  LocateStudy study{
      .count = kBalls, .seed = 3, .script = "search", .round_trip = 0.2, .loss = 0.05};
  ASSERT_TRUE(take_ball("depth=5 radius=14 ratio=500 at=-2,5", study));
  const auto bench = LocateBench::make(study);
  ASSERT_TRUE(bench);
  std::uint32_t right = 0;
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    const LocateCase one = bench->run(i);
    right += one.right() ? 1U : 0U;
    EXPECT_TRUE(one.found);
    EXPECT_GE(one.strokes, 3U);
    EXPECT_LT(one.strokes, 20U);
  }
  EXPECT_GE(right, 3U);
}

TEST(LocateSessionTest, PlainTissueHasNoBall) {
  const auto bench = LocateBench::make({.count = 1, .seed = 3, .script = "map"});
  ASSERT_TRUE(bench);
  const LocateCase plain = bench->run(1);
  EXPECT_FALSE(plain.inclusion);
  EXPECT_FALSE(plain.found);
  EXPECT_FALSE(plain.confidently_wrong());
}

TEST(LocateSessionTest, AnIntervalThatMissesWithoutAWordIsConfidentlyWrong) {
  LocateCase one;
  one.inclusion = one.found = true;
  for (Located& coordinate : one.coordinates) coordinate = {6e-3, 6e-3, 5e-3, 7e-3, 1e-3};
  EXPECT_FALSE(one.confidently_wrong());
  EXPECT_TRUE(one.right());
  one.coordinates[3].low = 6.5e-3;  // the radius
  EXPECT_TRUE(one.confidently_wrong());
  EXPECT_FALSE(one.right());
  one.doubts = 1;
  EXPECT_FALSE(one.confidently_wrong());
  one = {};
  one.found = true;
  EXPECT_TRUE(one.confidently_wrong()) << "nothing is there";
}

TEST(LocateStudyTest, WorldsThatDoNotMatchAreJudgedByKind) {
  const LocateStudy study{.count = 10, .seed = 5, .mismatch = true};
  const auto bench = LocateBench::make(study);
  ASSERT_TRUE(bench);
  EXPECT_EQ(case_count(study), 10U);
  std::vector<LocateCase> cases;
  for (std::uint32_t i = 0; i < case_count(study); ++i) {
    cases.push_back(bench->run(i));
    EXPECT_EQ(static_cast<std::uint32_t>(cases.back().kind), i);
  }
  EXPECT_NE(locate_table(study, cases).find("sensor pole"), std::string::npos);
  EXPECT_NE(locate_report(study, cases, "").find("\"confident_wrong\""), std::string::npos);
}

}  // namespace
}  // namespace palp::lab
