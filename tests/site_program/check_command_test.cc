#include "site_program/check_command.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/common/io/secure/keys_folder.h"

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

config::ExitCode code_of(std::vector<const char*> words) {
  config::CommandLine line{"palp-surgeon", "A site."};
  line.verbs_optional();
  const CheckCommand check{line, link::Role::Surgeon};
  words.insert(words.begin(), {"palp-surgeon", "check"});
  EXPECT_FALSE(line.parse(static_cast<int>(words.size()), words.data()));
  return check.run().code;
}

TEST(CheckCommandTest, WhatCannotBeOpenedIsNotTheSameAsAWrongWord) {
  EXPECT_EQ(code_of({"--peer", "127.0.0.1:9"}), config::ExitCode::BadInput) << "no identity";
  EXPECT_EQ(code_of({"--peer", "127.0.0.1:9", "--identity", "/nowhere"}),
            config::ExitCode::CannotOpen);
  EXPECT_EQ(code_of({"--identity", "/nowhere"}), config::ExitCode::CannotOpen);
}

TEST(CheckCommandTest, AnIdentityWithCautionsIsToBeChanged) {
  const io::test::KeysFolder keys{"check"};
  EXPECT_TRUE(judge_identity(*keys.credentials(link::Role::Patient)).good);
  std::filesystem::permissions(keys.site(link::Role::Patient) / "key.pem",
                               std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  const io::MachineFinding finding = judge_identity(*keys.credentials(link::Role::Patient));
  EXPECT_FALSE(finding.good);
  EXPECT_THAT(finding.advice, testing::HasSubstr("chmod 600"));
}

}  // namespace
}  // namespace palp::site_program
