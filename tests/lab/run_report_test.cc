#include "lab/run_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::lab {
namespace {

TEST(RunReportTest, BeginsWithItsSchemaAlsoWhenNothingWasMeasured) {
  const std::string text = run_report(Scenario{}, TrialResult{}, {.scenario = "empty"});
  const auto report = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(report.begin().key(), "schema");
  EXPECT_EQ(report.begin().value(), "palp.run/1");
}

TEST(RunReportTest, ReportAndSummaryTellTheDigest) {
  TrialResult result;
  result.digest = 0x0123456789abcdef;
  const RunAccount account{.scenario = "empty"};
  for (const std::string& text :
       {run_report(Scenario{}, result, account), run_summary(Scenario{}, result, account)}) {
    EXPECT_NE(text.find("0123456789abcdef"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace palp::lab
