#include "lab/report/run_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/plan/scenario_file.h"

namespace palp::lab {
namespace {

Scenario metro() { return make_scenario("metro", load_scenario("metro").value()).value(); }

TEST(RunReportTest, BeginsWithItsSchemaAlsoWhenNothingWasMeasured) {
  const std::string text = run_report(metro(), RunResult{}, {.scenario = "metro"});
  const auto report = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(report.begin().key(), "schema");
  EXPECT_EQ(report.begin().value(), "palp.run/1");
}

TEST(RunReportTest, ReportAndSummaryTellTheDigest) {
  RunResult result;
  result.digest = 0x0123456789abcdef;
  const RunAccount account{.scenario = "metro"};
  for (const std::string& text :
       {run_report(metro(), result, account), run_summary(metro(), result, account)}) {
    EXPECT_NE(text.find("0123456789abcdef"), std::string::npos) << text;
  }
}

TEST(RunReportTest, TellsWhatASessionFileLacks) {
  const auto fault_of = [](const RunAccount& account) {
    return nlohmann::json::parse(run_report(metro(), RunResult{}, account)).at("recording_fault");
  };
  EXPECT_TRUE(fault_of({.scenario = "metro"}).is_null());
  EXPECT_EQ(fault_of({.scenario = "metro", .recording_fault = "disk full"}), "disk full");
}

TEST(RunReportTest, WhatWasNotMeasuredIsADash) {
  RunResult result;
  result.metrics.taps.resize(1);
  const std::string text = run_summary(metro(), result, {.scenario = "metro", .cpu = 1});
  EXPECT_NE(text.find("holds A -, B -"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
}

}  // namespace
}  // namespace palp::lab
