#include "common/config/output_clash.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/own_path.h"

namespace palp::config {
namespace {

using testing::HasSubstr;

class OutputClashTest : public testing::Test {
 protected:
  OutputClashTest() { std::filesystem::create_directories(folder_); }
  ~OutputClashTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }
  [[nodiscard]] std::string made(const std::string& name) const {
    std::ofstream{path(name)} << "content";
    return path(name);
  }
  [[nodiscard]] bool clashes(const std::string& report,
                             std::vector<std::string> words,
                             const std::string& settings = {}) const {
    words.insert(words.begin(), {"palp-x", "run"});
    words.insert(words.end(), {"--report", report, "--report=" + report});
    return output_clash({"--report", report}, words, "run", settings).has_value();
  }

 private:
  std::string folder_ = test::own_path("clash");
};

TEST_F(OutputClashTest, AFileThatIsReadOrWrittenIsNotTakenByAnother) {
  const std::string there = made("cases.csv");
  const std::string absent = path("new.json");
  for (const std::string& file : {there, absent}) {
    EXPECT_TRUE(clashes(file, {file}));
    EXPECT_TRUE(clashes(file, {"--session-file", file}));
    EXPECT_TRUE(clashes(file, {"--session-file=" + file}));
    EXPECT_TRUE(clashes(file, {"--phantom", "file:" + file}));
    EXPECT_TRUE(clashes(file, {"--set", "phantom=file:" + file}));
    EXPECT_TRUE(clashes(file, {}, "a: 1 phantom: \"file:" + file + "\" b: \"\""));
    EXPECT_FALSE(clashes(file, {path("other"), "--seed", "1"}, "b: \"other\""));
  }
  EXPECT_THAT(output_clash({"--report", there}, {"palp-x", "--cases", there}, "", "").value(),
              HasSubstr("--report and --cases name one file, "));
}

TEST_F(OutputClashTest, UnderAnyName) {
  const std::string there = made("a.csv");
  std::filesystem::create_symlink(there, path("link"));
  std::filesystem::create_hard_link(there, path("hard"));
  EXPECT_TRUE(clashes(path("link"), {there}));
  EXPECT_TRUE(clashes(there, {path("hard")}));
  EXPECT_TRUE(clashes(path("./x/../new"), {path("new")}));
  EXPECT_FALSE(clashes("/dev/null", {"--csv", "/dev/null"})) << "nothing is lost there";
}

TEST_F(OutputClashTest, NamesThatProgramsMakeOfThoseTheyAreGiven) {
  EXPECT_TRUE(clashes(path("s-surgeon.mcap"), {"--session-files", path("s-")}));
  EXPECT_TRUE(clashes(path("s-001.mcap"), {"--session-files", path("s-")}));
  EXPECT_FALSE(clashes(path("s-last.mcap"), {"--session-files", path("s-")}));
  EXPECT_TRUE(clashes(path("c.csv.partial"), {"--cases", path("c.csv")}));
  for (const char* const name : {"key.pem", "revoked.pem", "pre_shared_key.txt"}) {
    EXPECT_TRUE(clashes(made(name), {"--identity", path("")})) << name;
  }
  EXPECT_FALSE(clashes(path("report.json"), {"--session-files", path("")}));
}

TEST_F(OutputClashTest, WhatAScenarioNamesIsNotTakenEither) {
  const std::string scenario = path("mine.textproto");
  std::ofstream{scenario} << "surgeon { script: \"" << path("press.txt") << "\" }";
  EXPECT_TRUE(clashes(path("press.txt"), {scenario}));
  EXPECT_TRUE(clashes(path("press.txt"), {"--config=" + scenario}));
  EXPECT_FALSE(clashes(path("other.txt"), {scenario}));
  EXPECT_FALSE(clashes(path("press.txt"), {path("absent.textproto")}));
}

TEST_F(OutputClashTest, ASessionFileIsTakenByNoOutput) {
  std::ofstream{path("s.mcap")} << "\x89MCAP0\r\nrecorded once";
  std::filesystem::create_symlink("s.mcap", path("link"));
  for (const char* const name : {"s.mcap", "link"}) {
    EXPECT_THAT(output_clash({"--csv", path(name)}, {"palp-x"}, "", "").value(),
                HasSubstr("a session file"));
  }
  EXPECT_FALSE(output_clash({"--csv", made("old.csv")}, {"palp-x"}, "", ""));
  EXPECT_FALSE(output_clash({"--csv", path("new.csv")}, {"palp-x"}, "", ""));
}

TEST_F(OutputClashTest, AVerbOrANumberIsNoFile) {
  EXPECT_FALSE(clashes("run", {"--seed", "1"}));
  EXPECT_FALSE(clashes("7", {"--seed", "7"}));
}

}  // namespace
}  // namespace palp::config
