#include "common/config/exit_status.h"

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

TEST(ExitStatusTest, ARefusalTellsWhatIsWrongFromWhatCannotBeRead) {
  const ExitStatus wrong = refusal("palp-x", {"a is 3, allowed are 1 and 2"});
  EXPECT_EQ(wrong.code, ExitCode::BadInput);
  EXPECT_EQ(wrong.text, "palp-x: a is 3, allowed are 1 and 2");
  EXPECT_EQ(refusal("palp-x", fail_to_reach("no file 'b'").value()).code, ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::config
