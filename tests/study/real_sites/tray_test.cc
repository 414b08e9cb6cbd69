#include "study/real_sites/tray.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "patient_site/phantom.h"
#include "study/orders.h"

namespace palp::study {
namespace {

Study study_of(const std::string& more = "") {
  return *parse_study("name: \"s\" seed: 7 condition { name: \"one\" } " + more, "s");
}

const std::string kSearch =
    "task: \"locate\" ball { radius_mm: 8 ratio: 100 } depth { top_mm: 5 contrast_ln: 0.42 } depth "
    "{ "
    "top_mm: 10 contrast_ln: 0.13 } depth { top_mm: 15 contrast_ln: 0.05 } ";

double level_at(const Tray& tray, const Place& place) {
  return std::ranges::find(tray.places, place, &TrayPlace::place)->level;
}

TEST(TrayTest, HoldsEachLevelsTissueAtItsPlaceExactly) {
  const Study study = study_of();
  const Tray tray = *make_tray(study);
  const patient::ForceTable plain = patient::make_phantom("none")->plain;
  const auto curves =
      patient::parse_tissue_curves(tissue_text(tray, study, LevelCurves{}), "tray", {});
  ASSERT_TRUE(curves) << curves.error().text;
  ASSERT_EQ(curves->size(), tray.places.size());
  for (const double depth : {1e-3, 3.3e-3, 6e-3}) {
    for (std::size_t i = 0; i < tray.places.size(); ++i) {
      EXPECT_NEAR((*curves)[i].table.force(depth),
                  plain.force(depth) * std::exp(tray.places[i].level),
                  1e-6);
      EXPECT_LT(distance((*curves)[i].place, tray.places[i].place), 1e-6);
    }
  }
  for (const double level : study.levels) {
    EXPECT_EQ(std::ranges::count(tray.places, level, &TrayPlace::level), 1);
  }
}

// Where what levels are compared with lay at one place only, its place would tell it.
TEST(TrayTest, PlacesAreApartAndTellNothingOfTheLevel) {
  const Study study = study_of();
  const Tray tray = *make_tray(study);
  std::vector<Place> all;
  for (const TrayPlace& one : tray.places) all.push_back(one.place);
  all.insert(all.end(), tray.decoys.begin(), tray.decoys.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(distance(all[i], all[j]), 3.9e-3);
  }
  EXPECT_EQ(std::ranges::count(tray.places, 0.0, &TrayPlace::level), 25);
  int rising = 0;
  for (std::size_t i = 2; i <= 25; ++i) {
    rising += tray.places[i].place.x > tray.places[i - 1].place.x ? 1 : 0;
  }
  EXPECT_GT(rising, 4);
  EXPECT_LT(rising, 20);
  Study other = study;
  other.seed = 8;
  EXPECT_NE(make_tray(other)->places[1].place, tray.places[1].place);
  std::set<std::pair<double, double>> references;
  for (std::size_t number = 0; number < 60; ++number) {
    const auto places = places_of(tray, study, {.number = number, .level = 0.3, .stronger = 1});
    references.emplace(places[0].x, places[0].y);
  }
  EXPECT_GT(references.size(), 15U);
}

TEST(TrayTest, ATrialHasItsLevelInOneIntervalAndTheReferenceInTheOthers) {
  const Study study = study_of("intervals: 3");
  const Tray tray = *make_tray(study);
  const auto places = places_of(tray, study, {.level = study.levels[9], .stronger = 2});
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(level_at(tray, places[0]), 0);
  EXPECT_EQ(level_at(tray, places[1]), 0);
  EXPECT_EQ(level_at(tray, places[2]), study.levels[9]);
}

TEST(TrayTest, ARankingHasItsThreeTissuesInTheOrderAsked) {
  const Study study = study_of("task: \"rank\"");
  const Tray tray = *make_tray(study);
  for (std::size_t order = 0; order < kOrders.size(); ++order) {
    const auto places = places_of(tray, study, {.level = study.levels[9], .stronger = order});
    ASSERT_EQ(places.size(), 3U);
    const Order& softest_first = kOrders[order];
    EXPECT_EQ(level_at(tray, places[softest_first[0]]), -study.levels[9]);
    EXPECT_EQ(level_at(tray, places[softest_first[1]]), 0);
    EXPECT_EQ(level_at(tray, places[softest_first[2]]), study.levels[9]);
  }
}

TEST(TrayTest, ADelayIsAskedForAtTwoPlacesOfOneTissue) {
  const Study study = study_of("task: \"delay\"");
  const Tray tray = *make_tray(study);
  const auto places = places_of(tray, study, {.level = 40, .stronger = 0});
  ASSERT_EQ(places.size(), 2U);
  EXPECT_GE(distance(places[0], places[1]), 3.9e-3);
  EXPECT_EQ(level_at(tray, places[0]), 0);
  EXPECT_EQ(level_at(tray, places[1]), 0);
}

// The area that is searched lies around the ball as the schedule says, and holds no other one.
TEST(TrayTest, ASearchHasOneBallInItsArea) {
  const Study study = study_of(kSearch);
  const Tray tray = *make_tray(study);
  const auto phantom = patient::make_phantom(tissue_text(tray, study, *LevelCurves::make(study)));
  ASSERT_TRUE(phantom) << phantom.error().text;
  ASSERT_EQ(phantom->block->inclusions.size(), 3U);
  const auto field = patient::make_field(*phantom, 0);
  for (const double level : study.levels) {
    for (const Place hidden : {Place{}, Place{18e-3, -20e-3}, Place{-20e-3, 3e-3}}) {
      const Place middle = places_of(tray, study, {.level = level, .hidden = hidden}).front();
      const Place axis = axis_of(tray, level);
      EXPECT_LT(distance({middle.x + hidden.x, middle.y + hidden.y}, axis), 1e-9);
      const double above = field->elastic_force(axis, 3e-3);
      for (double x = -20e-3; x <= 20e-3; x += 5e-3) {
        for (double y = -20e-3; y <= 20e-3; y += 5e-3) {
          EXPECT_LE(field->elastic_force({middle.x + x, middle.y + y}, 3e-3), above * (1 + 1e-9));
        }
      }
    }
  }
}

TEST(TrayTest, WhatHasNoRoomIsRefused) {
  EXPECT_TRUE(make_tray(study_of("levels { count: 61 }")));
  EXPECT_FALSE(make_tray(study_of("task: \"rank\" levels { count: 61 }")));
  std::string depths = "task: \"locate\" ball { radius_mm: 8 ratio: 100 } ";
  for (int i = 0; i < 55; ++i) {
    depths += "depth { top_mm: " + std::to_string(5 + i) +
              " contrast_ln: " + std::to_string(0.5 - 0.008 * i) + " } ";
  }
  const auto refused = make_tray(study_of(depths));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("fewer depths"), std::string::npos);
}

TEST(TrayTest, AsManyLevelsAsAStudyMayHaveFitATissue) {
  const Study study = study_of("levels { count: 61 }");
  const auto csv = tissue_text(*make_tray(study), study, LevelCurves{});
  EXPECT_TRUE(patient::parse_tissue_curves(csv, "tray", {}));
}

}  // namespace
}  // namespace palp::study
