#include "netem/presets_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "netem/syntax/presets.h"

namespace palp::netem {
namespace {

config::ExitStatus listed(std::initializer_list<const char*> words) {
  config::CommandLine line{"palp-netem", "tests"};
  const PresetsCommand command{line};
  std::vector<const char*> argv{"palp-netem", "presets"};
  argv.insert(argv.end(), words);
  const auto refused = line.parse(static_cast<int>(argv.size()), argv.data());
  return refused ? *refused : command.run();
}

TEST(PresetsCommandTest, ScriptsGetEveryPresetWithItsSources) {
  const auto json = nlohmann::json::parse(listed({"--json"}).text);
  EXPECT_EQ(json["schema"], "palp.presets/1");
  ASSERT_EQ(json["presets"].size(), preset_names().size());
  for (std::size_t i = 0; i < preset_names().size(); ++i) {
    EXPECT_EQ(json["presets"][i]["name"], preset_names()[i]);
    EXPECT_FALSE(json["presets"][i]["sources"].empty());
  }
}

TEST(PresetsCommandTest, OneAloneComesWithItsFile) {
  EXPECT_EQ(nlohmann::json::parse(listed({"lan", "--json"}).text)["presets"].size(), 1U);
  EXPECT_THAT(listed({"lan"}).text, testing::HasSubstr(std::string{preset_text("lan")}));
}

TEST(PresetsCommandTest, AnUnknownOneIsBadInputThatListsTheOthers) {
  const config::ExitStatus refused = listed({"moon"});
  EXPECT_EQ(refused.code, config::ExitCode::BadInput);
  EXPECT_THAT(refused.text, testing::HasSubstr("transatlantic"));
}

}  // namespace
}  // namespace palp::netem
