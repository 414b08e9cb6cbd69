#include "study/real_sites/tray.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "patient_site/phantom.h"

namespace palp::study {
namespace {

Study study_of(const std::string& more = "") {
  return *parse_study("name: \"s\" seed: 7 condition { name: \"one\" } " + more, "s");
}

TEST(TrayTest, HoldsEachLevelsTissueAtItsPlaceExactly) {
  const Study study = study_of();
  const Tray tray = make_tray(study);
  const patient::ForceTable plain = patient::make_phantom("none")->plain;
  const auto curves =
      patient::parse_tissue_curves(tray_csv(tray, study, LevelCurves{}), "tray", {});
  ASSERT_TRUE(curves) << curves.error().text;
  ASSERT_EQ(curves->size(), study.levels.size() + 1);
  for (const double depth : {1e-3, 3.3e-3, 6e-3}) {
    EXPECT_NEAR((*curves)[0].table.force(depth), plain.force(depth), 1e-6);
    for (std::size_t i = 0; i < study.levels.size(); ++i) {
      EXPECT_NEAR((*curves)[i + 1].table.force(depth),
                  plain.force(depth) * std::exp(study.levels[i]),
                  1e-6);
      EXPECT_LT(distance((*curves)[i + 1].place, tray.levels[i]), 1e-6);
    }
  }
}

TEST(TrayTest, PlacesAreApartAndTellNothingOfTheLevel) {
  const Study study = study_of();
  const Tray tray = make_tray(study);
  std::vector<Place> all = tray.levels;
  all.push_back(tray.reference);
  all.insert(all.end(), tray.decoys.begin(), tray.decoys.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(distance(all[i], all[j]), 3.9e-3);
  }
  int rising = 0;
  for (std::size_t i = 1; i < tray.levels.size(); ++i) {
    rising += tray.levels[i].x > tray.levels[i - 1].x ? 1 : 0;
  }
  EXPECT_GT(rising, 4);
  EXPECT_LT(rising, 20);
  Study other = study;
  other.seed = 8;
  EXPECT_NE(make_tray(other).levels, tray.levels);
}

TEST(TrayTest, ATrialHasItsLevelInOneIntervalAndTheReferenceInTheOthers) {
  const Study study = study_of("intervals: 3");
  const Tray tray = make_tray(study);
  const auto places = places_of(tray, study, {.level = study.levels[9], .stronger = 2});
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(places[0], tray.reference);
  EXPECT_EQ(places[1], tray.reference);
  EXPECT_EQ(places[2], tray.levels[9]);
}

TEST(TrayTest, AsManyLevelsAsAStudyMayHaveFitATissue) {
  const Study study = study_of("levels { count: 61 }");
  const Tray tray = make_tray(study);
  const auto csv = tray_csv(tray, study, LevelCurves{});
  EXPECT_TRUE(patient::parse_tissue_curves(csv, "tray", {}));
}

}  // namespace
}  // namespace palp::study
