#include "review/report_curves.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::review {
namespace {

judge::RunTick tick_at(int ms) {
  judge::RunTick tick;
  tick.at = 1e-3 * ms;
  tick.counted = true;
  tick.hand = -1e-3;
  return tick;
}

nlohmann::json series_of(const ReportCurves& curves) {
  config::Json series;
  curves.add_to(series);
  return nlohmann::json::parse(series.dump());
}

TEST(ReportCurvesTest, AShortSessionIsDrawnTickByTick) {
  ReportCurves curves;
  for (int ms = 0; ms < 1000; ++ms) curves.see(tick_at(ms));
  EXPECT_EQ(series_of(curves)["t"].size(), 1000U);
}

TEST(ReportCurvesTest, NoPeakOfALongSessionIsLostBetweenItsPoints) {
  ReportCurves curves;
  for (int ms = 0; ms < 100'000; ++ms) {
    judge::RunTick tick = tick_at(ms);
    if (ms == 31'415) tick.hand_force = 7;
    if (ms == 92'653) tick.hand_force = -3;
    curves.see(tick);
  }
  const nlohmann::json series = series_of(curves);
  EXPECT_LE(series["t"].size(), 12'000U);
  double least = 0;
  double most = 0;
  double before = -1;
  for (std::size_t i = 0; i < series["t"].size(); ++i) {
    EXPECT_GT(series["t"][i].get<double>(), before) << "in order of time";
    before = series["t"][i].get<double>();
    least = std::min(least, series["felt"][i].get<double>());
    most = std::max(most, series["felt"][i].get<double>());
  }
  EXPECT_EQ(most, 7);
  EXPECT_EQ(least, -3);
}

TEST(ReportCurvesTest, NoLineLeadsThroughTimeThatNobodyWroteDown) {
  ReportCurves curves;
  for (int ms = 0; ms < 500; ++ms) curves.see(tick_at(ms));
  for (int ms = 520; ms < 1000; ++ms) curves.see(tick_at(ms));  // a pause of the process
  for (int ms = 3000; ms < 3500; ++ms) curves.see(tick_at(ms));
  const nlohmann::json series = series_of(curves);
  int gaps = 0;
  for (std::size_t i = 0; i < series["t"].size(); ++i) {
    if (!series["hand"][i].is_null()) continue;
    ++gaps;
    EXPECT_NEAR(series["t"][i].get<double>(), 2, 0.01);
    for (const char* name : {"felt", "touched", "truth", "x", "y", "energy", "energy_tissue"}) {
      EXPECT_TRUE(series[name][i].is_null()) << name;
    }
  }
  EXPECT_EQ(gaps, 1);
  ASSERT_EQ(series["idle"].size(), 1U);
  EXPECT_NEAR(series["idle"][0][0].get<double>(), 0.999, 1e-9);
  EXPECT_NEAR(series["idle"][0][1].get<double>(), 3, 1e-9);
}

TEST(ReportCurvesTest, NorThroughAGapThatTwoPointsOfOneBucketSpan) {
  ReportCurves curves;
  for (int ms = 0; ms < 40'007; ++ms) {
    curves.see(tick_at(ms < 20'003 ? ms : ms + 5000));
  }
  const nlohmann::json series = series_of(curves);
  int gaps = 0;
  for (const auto& hand : series["hand"]) gaps += hand.is_null() ? 1 : 0;
  EXPECT_EQ(gaps, 1);
}

TEST(ReportCurvesTest, EachTimeTheHandWentInDeepIsALoop) {
  ReportCurves curves;
  const auto stroke = [&](int from, double depth) {
    for (int ms = from; ms < from + 500; ++ms) {
      judge::RunTick tick = tick_at(ms);
      tick.hand = depth;
      curves.see(tick);
    }
    curves.see(tick_at(from + 500));
  };
  stroke(0, 2e-3);
  stroke(1000, 1e-3);  // too shallow
  stroke(2000, 3e-3);
  judge::RunTick idle = tick_at(3000);
  idle.counted = false;
  curves.see(idle);
  judge::RunTick still = tick_at(3001);
  still.hand = 4e-3;
  curves.see(still);
  const nlohmann::json series = series_of(curves);
  ASSERT_EQ(series["loops"].size(), 3U) << "and the one that is not over";
  EXPECT_EQ(series["loops"][1]["at"].get<double>(), 2);
  EXPECT_LE(series["loops"][0]["d"].size(), 150U);
  EXPECT_EQ(series["idle"].size(), 4U) << "three half seconds that nobody wrote down, and the tick";
}

}  // namespace
}  // namespace palp::review
