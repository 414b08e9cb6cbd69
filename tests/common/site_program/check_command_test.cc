#include "common/site_program/check_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::site_program {
namespace {

const std::vector<io::MachineFinding> kFindings{{"clock", "tsc", true, ""},
                                                {"processors", "1 usable", false, "two at least"}};

TEST(CheckCommandTest, SaysWhatToChangeBelowWhatIsNotGood) {
  const std::string text = check_text(kFindings);
  EXPECT_THAT(text, testing::StartsWith("good    clock                 tsc\nchange  processors"));
  EXPECT_THAT(text, testing::EndsWith("-> two at least\n"));
}

TEST(CheckCommandTest, TheReportNamesEachFinding) {
  const auto json = nlohmann::json::parse(check_json(kFindings));
  EXPECT_EQ(json["schema"], "palp.check/1");
  EXPECT_EQ(json["findings"][1]["what"], "processors");
  EXPECT_EQ(json["findings"][1]["good"], false);
  EXPECT_EQ(json["findings"][0]["advice"], "");
}

}  // namespace
}  // namespace palp::site_program
