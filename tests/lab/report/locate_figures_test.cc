// Goal: figures of a study of maps count what they say. Method: cases made by hand.
#include "lab/report/locate_figures.h"

#include <numeric>

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

/// A ball that was found, said to be `off` [m] from where it is.
LocateCase found_at(double x, double depth, double radius, double off = 0) {
  LocateCase one;
  one.inclusion = one.found = true;
  one.ratio = 100;
  const std::array<double, kLocated> truth{x, 0, depth, radius, std::log(100.0)};
  for (std::size_t i = 0; i < kLocated; ++i) {
    const double median = truth[i] + off;
    one.coordinates[i] = {truth[i], median, median - 1e-3, median + 1e-3, 0.5e-3};
  }
  return one;
}

TEST(LocateFiguresTest, ErrorsAreTheRootMeanSquareAndIntervalsHoldOrNot) {
  const LocateFigures all =
      figures_of_all({found_at(0, 6e-3, 8e-3, 2e-3), found_at(0, 6e-3, 8e-3, 0)});
  EXPECT_EQ(all.found, 2U);
  EXPECT_EQ(all.inside[0], 1U);
  EXPECT_NEAR(all.rmse[0], 2e-3 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(all.bounds[0], 0.5e-3, 1e-12);
}

TEST(LocateFiguresTest, EveryBallIsInOneCell) {
  std::vector<LocateCase> cases;
  for (const double radius : {3e-3, 7e-3, 8e-3, 12e-3, 16e-3}) {
    for (const double depth : {3e-3, 12e-3, 27e-3}) cases.push_back(found_at(0, depth, radius));
  }
  const auto cells = cells_of({}, cases);
  ASSERT_EQ(cells.size(), 9U);
  const auto count = std::accumulate(
      cells.begin(), cells.end(), std::size_t{}, [](std::size_t sum, const LocateCell& cell) {
        return sum + cell.figures.count;
      });
  EXPECT_EQ(count, cases.size());
  EXPECT_EQ(cells.front().radius[0], 3e-3);
  EXPECT_DOUBLE_EQ(cells.back().depth[1], 27e-3);
}

TEST(LocateFiguresTest, BelowTheMiddlePlaceIsWithinHalfAPitch) {
  LocateStudy study;
  study.pitch = 8e-3;
  const auto rows = rows_of(study, {found_at(3.9e-3, 6e-3, 8e-3), found_at(4.1e-3, 6e-3, 8e-3)});
  EXPECT_EQ(rows[0].figures.count, 2U);
  EXPECT_EQ(rows[1].figures.count, 1U);
  EXPECT_EQ(rows_of(study, {found_at(0, 11e-3, 8e-3)})[0].figures.count, 0U) << "not near";
}

TEST(LocateFiguresTest, NeverIsLaterThanAnyNumberOfTouches) {
  std::vector<LocateCase> cases(4, found_at(0, 6e-3, 8e-3));
  cases[0].searched.known = 5;
  cases[1].searched.known = 9;
  cases[2].searched.known = 7;
  EXPECT_EQ(touches_of(cases, &Searched::known), 8) << "the mean of 7 and 9";
  EXPECT_EQ(touches_of(cases, &Searched::known, 0.25), 6);
  EXPECT_EQ(touches_of(cases, &Searched::known, 0.9), 0) << "one of four never";
  EXPECT_EQ(touches_of({}, &Searched::known), 0);
}

TEST(LocateFiguresTest, ADoubtOfTheModelIsOneOfAllDoubts) {
  std::vector<LocateCase> cases(4);
  cases[0].doubts = doubts_of(MapDoubt::Curve);
  cases[1].doubts = doubts_of(MapDoubt::Outside);
  cases[2].found = true;
  const LocateAlarms told = alarms(cases);
  EXPECT_EQ(told.all, 4U);
  EXPECT_EQ(told.plain, 4U);
  EXPECT_EQ(told.found, 1U);
  EXPECT_EQ(told.doubted, 2U);
  EXPECT_EQ(told.model, 1U);
}

TEST(LocateFiguresTest, ASessionTellsNoRatio) {
  LocateStudy study;
  EXPECT_TRUE(tells(study, 4));
  study.script = "map";
  EXPECT_TRUE(tells(study, 3));
  EXPECT_FALSE(tells(study, 4));
}

}  // namespace
}  // namespace palp::lab
