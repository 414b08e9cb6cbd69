// Goal: a study of maps is repeatable and its reports say what its cases say. Method: a few small
// studies.
#include "lab/plan/locate_study.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/json.h"
#include "lab/locate_command.h"
#include "lab/report/locate_picture.h"

namespace palp::lab {
namespace {

TEST(LocateStudyTest, ACaseIsRepeatableAndHoldsItsTruth) {
  const auto bench = LocateBench::make({.count = 1, .seed = 3, .depth_max = 8e-3});
  ASSERT_TRUE(bench);
  const LocateCase one = bench->run(0);
  const LocateCase again = bench->run(0);
  EXPECT_TRUE(one.inclusion);
  EXPECT_EQ(one.log_evidence, again.log_evidence);
  for (std::size_t i = 0; i < kLocated; ++i) {
    EXPECT_EQ(one.coordinates[i].median, again.coordinates[i].median);
    EXPECT_LT(one.coordinates[i].low, one.coordinates[i].high);
    EXPECT_GT(one.coordinates[i].bound, 0);
  }
  const LocateCase plain = bench->run(1);
  EXPECT_FALSE(plain.inclusion);
  EXPECT_NE(plain.scale, one.scale);
}

LocateCase told(std::uint32_t index, bool inclusion, bool found) {
  LocateCase one;
  one.index = index;
  one.inclusion = inclusion;
  one.found = found;
  one.ratio = 100;
  for (Located& coordinate : one.coordinates) coordinate = {6e-3, 6e-3, 5e-3, 7e-3, 1e-3};
  return one;
}

TEST(LocateStudyTest, ReportsCountWhatWasFoundAndWhatWasNot) {
  LocateStudy study;
  study.count = 2;
  std::vector<LocateCase> cases{
      told(0, true, true), told(1, true, false), told(2, false, true), told(3, false, false)};
  cases[0].coordinates[2].high = 5.5e-3;  // misses the depth
  const std::string report = locate_report(study, cases, "");
  EXPECT_THAT(report, testing::HasSubstr("\"false_alarm_rate\": 0.5"));
  const auto json = config::Json::parse(report);
  EXPECT_EQ(json["coverage95"]["depth"].number(), 0);
  EXPECT_EQ(json["coverage95"]["x"].number(), 1);
  EXPECT_EQ(json["rmse_mm"]["depth"].number(), 0);
  EXPECT_EQ(json["cells"].parts().size(), 9U);
  EXPECT_TRUE(json["update_ms"]["p50"].is_null()) << "nobody looked at a clock";
  EXPECT_THAT(locate_table(study, cases), testing::HasSubstr("false alarms 50.00 %"));
  const std::string csv = locate_csv(study, cases);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_EQ(locate_figure(cases).panels.size(), 3U);
}

TEST(LocateStudyTest, ARuleOfTheNextTapGoesWithNoSessionAndIsReported) {
  LocateFlags flags;
  flags.rule = "gp";
  EXPECT_EQ(run_locate(flags, {}).code, config::ExitCode::BadInput);
  flags.search = flags.session = true;
  EXPECT_EQ(run_locate(flags, {}).code, config::ExitCode::BadInput);
  const LocateStudy study{.count = 1, .rule = TapRule::Gp};
  std::vector<LocateCase> cases{told(0, true, true), told(1, true, true), told(2, true, true)};
  cases[0].searched.known = 9;
  cases[1].searched.known = 12;
  const std::string report = locate_report(study, cases, "");
  EXPECT_THAT(report, testing::HasSubstr("\"search\": \"gp\""));
  const auto json = config::Json::parse(report);
  EXPECT_EQ(json["taps_to_1mm"]["p50"].number(), 12) << "never is late";
  EXPECT_TRUE(json["taps_to_1mm"]["p90"].is_null());
  EXPECT_TRUE(json["taps_to_place"]["p50"].is_null());
}

TEST(LocateStudyTest, TheCommandTakesItsFlags) {
  LocateFlags flags;
  config::CommandLine line{"palp-lab", ""};
  declare_locate(line.verb("locate", "x"), flags);
  EXPECT_EQ(flags.taps, 9U);
}

}  // namespace
}  // namespace palp::lab
