#include "common/config/exit_status.h"

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

namespace palp::config {
namespace {

TEST(ExitStatusTest, GivesTheExitStatusOfEachCode) {
  EXPECT_EQ(leave({ExitCode::Done, "done"}), 0);
  EXPECT_EQ(leave({ExitCode::Missed, "missed"}), 1);
  EXPECT_EQ(leave({ExitCode::BadInput, "bad"}), 2);
  EXPECT_EQ(leave({ExitCode::CannotOpen, "closed"}), 3);
  EXPECT_EQ(leave({ExitCode::CutShort, "cut"}), 4);
}

TEST(ExitStatusTest, PrintsOneLineEndAndNothingForAnEmptyText) {
  testing::internal::CaptureStdout();
  (void)leave({ExitCode::Done, ""});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  testing::internal::CaptureStdout();
  (void)leave({ExitCode::Done, "done"});
  (void)leave({ExitCode::Done, "done\n"});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "done\ndone\n");
}

/// Where every write fails: the disk is full.
int leave_onto_a_full_disk(ExitCode code, const std::string& printed_before) {
  if (std::freopen("/dev/full", "w", stdout) == nullptr) return -1;
  std::cout << printed_before;
  return leave({code, code == ExitCode::Done ? "done" : "failed"});
}

TEST(ExitStatusTest, WhatCouldNotBePrintedIsNotDone) {
  EXPECT_EXIT(std::exit(leave_onto_a_full_disk(ExitCode::Done, "")),
              testing::ExitedWithCode(3),
              "standard output could not be written: No space left on device");
  const std::string long_table(100'000, 'x');  // written before the end
  EXPECT_EXIT(std::exit(leave_onto_a_full_disk(ExitCode::Done, long_table)),
              testing::ExitedWithCode(3),
              "standard output could not be written");
  EXPECT_EXIT(std::exit(leave_onto_a_full_disk(ExitCode::Missed, "a table")),
              testing::ExitedWithCode(1),
              "failed\n.*standard output could not be written");
}

TEST(ExitStatusTest, ARefusalTellsWhatIsWrongFromWhatCannotBeRead) {
  const ExitStatus wrong = refusal("palp-x", {"a is 3, allowed are 1 and 2"});
  EXPECT_EQ(wrong.code, ExitCode::BadInput);
  EXPECT_EQ(wrong.text, "palp-x: a is 3, allowed are 1 and 2");
  EXPECT_EQ(refusal("palp-x", fail_to_reach("no file 'b'").value()).code, ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::config
