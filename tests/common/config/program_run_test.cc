#include "common/config/program_run.h"

#include <filesystem>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/report.h"
#include "common/config/settings_text.h"
#include "common/core/whole_file.h"
#include "tests/support/own_path.h"

namespace palp::config {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A program with a verb that reports to a file of its own, removed at the end.
class ProgramRunTest : public testing::Test {
 protected:
  ProgramRunTest() {
    CommandLine& verb = line_.verb("try", "tries");
    verb.report(report_, "palp.try/1");
    verb.argument("FILE", input_, "read");
    verb.output("--svg", picture_, "drawn");
    verb.number("--rate", rate_, {.min = 0, .max = 1}, "how fast");
  }
  ~ProgramRunTest() override { std::filesystem::remove(file_); }

  int run(std::vector<std::string> words,
          const std::function<ExitStatus()>& body,
          const MayReport& may_report = {}) {
    words.insert(words.end(), {"--report", file_});
    std::vector<const char*> argv{"palp-x", "try"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    return run_program(line_, static_cast<int>(argv.size()), argv.data(), body, may_report);
  }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::string written() const { return read_whole_file(file_).value_or(""); }

 private:
  std::string file_ = test::own_path("run_test");
  CommandLine line_{"palp-x", "does x"};
  std::string report_;
  std::string input_;
  std::string picture_;
  double rate_{1};
};

TEST_F(ProgramRunTest, AFailedRunIsReportedToo) {
  EXPECT_EQ(run({}, [] { return ExitStatus{ExitCode::CannotOpen, "the door is \"shut\""}; }), 3);
  EXPECT_THAT(written(),
              AllOf(HasSubstr(R"("schema": "palp.try/1")"),
                    HasSubstr(R"("outcome": "cannot start")"),
                    HasSubstr(R"("reason": "the door is \"shut\"")")));
}

TEST_F(ProgramRunTest, WhatIsThrownIsReported) {
  EXPECT_EQ(run({}, []() -> ExitStatus { throw std::runtime_error{"no such thing"}; }), 3);
  EXPECT_THAT(written(), HasSubstr("palp-x: no such thing"));
}

TEST_F(ProgramRunTest, AWrongFlagIsReportedAndNothingRuns) {
  bool ran = false;
  const auto body = [&] {
    ran = true;
    return ExitStatus{};
  };
  EXPECT_EQ(run({"--rate", "2"}, body), 2);
  EXPECT_THAT(written(), AllOf(HasSubstr(R"("outcome": "bad input")"), HasSubstr("--rate")));
  EXPECT_FALSE(ran);
}

TEST_F(ProgramRunTest, AnUnknownFlagIsReported) {
  EXPECT_EQ(run({"--speed", "2"}, [] { return ExitStatus{}; }), 2);
  EXPECT_THAT(written(), HasSubstr("--speed"));
}

TEST_F(ProgramRunTest, AReportNeverTakesThePlaceOfAnotherFile) {
  ASSERT_TRUE(write_whole_file(file(), "precious"));
  EXPECT_EQ(run({file()}, [] { return ExitStatus{}; }), 2);
  EXPECT_EQ(written(), "precious");
  EXPECT_EQ(run({"--speed", "2", file()}, [] { return ExitStatus{}; }), 2) << "of a wrong line";
  EXPECT_EQ(written(), "precious");
}

TEST_F(ProgramRunTest, NoOutputTakesThePlaceOfAnotherFileAndNothingRuns) {
  const std::string precious = file() + ".svg";
  ASSERT_TRUE(write_whole_file(precious, "precious"));
  bool ran = false;
  EXPECT_EQ(run({precious, "--svg", precious},
                [&] {
                  ran = true;
                  return ExitStatus{};
                }),
            2);
  EXPECT_FALSE(ran);
  EXPECT_THAT(written(), HasSubstr("--svg and an argument name one file")) << "in the report";
  EXPECT_EQ(run({"--svg", precious},
                [&] {
                  ran = true;
                  return ExitStatus{};
                }),
            0);
  EXPECT_TRUE(ran) << "an old picture is drawn anew";
  std::filesystem::remove(precious);
}

TEST_F(ProgramRunTest, WhereNoReportMayBeNoneIsWrittenAndNothingRuns) {
  ASSERT_TRUE(write_whole_file(file(), "precious"));
  bool ran = false;
  const auto body = [&] {
    ran = true;
    return ExitStatus{};
  };
  const auto nowhere = [](const std::string&) -> Result<void> { return fail("it is precious"); };
  EXPECT_EQ(run({}, body, nowhere), 2);
  EXPECT_EQ(run({"--speed", "2"}, body, nowhere), 2);
  EXPECT_FALSE(ran);
  EXPECT_EQ(written(), "precious");
}

TEST_F(ProgramRunTest, OfARunThatDidNotFailOnlyTheVerbReports) {
  EXPECT_EQ(run({}, [] { return ExitStatus{ExitCode::Missed, "short of the target"}; }), 1);
  EXPECT_EQ(written(), "");
}

}  // namespace
}  // namespace palp::config
