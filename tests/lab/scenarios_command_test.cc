#include "lab/scenarios_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::lab {
namespace {

config::ExitStatus listed(std::initializer_list<const char*> words) {
  config::CommandLine line{"palp-lab", "tests"};
  const ScenariosCommand command{line};
  std::vector<const char*> argv{"palp-lab", "scenarios"};
  argv.insert(argv.end(), words);
  const auto refused = line.parse(static_cast<int>(argv.size()), argv.data());
  return refused ? *refused : command.run();
}

TEST(ScenariosCommandTest, ScriptsFindTheSameNamesAsPeople) {
  const std::string text = listed({}).text;
  const auto json = nlohmann::json::parse(listed({"--json"}).text);
  EXPECT_EQ(json["schema"], "palp.scenarios/1");
  for (const char* const kind : {"scenarios", "sets"}) {
    ASSERT_FALSE(json[kind].empty());
    for (const auto& one : json[kind]) {
      EXPECT_THAT(text, testing::HasSubstr(one["name"].get<std::string>() + "  "));
      EXPECT_FALSE(one["means"].get<std::string>().empty());
    }
  }
}

}  // namespace
}  // namespace palp::lab
