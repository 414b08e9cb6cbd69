#include "common/io/process/diagnostics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(DiagnosticsTest, SentenceGoesToStandardErrorAsItStands) {
  testing::internal::CaptureStderr();
  start_diagnostics("palp-test");
  warn("the budget of {} is 5 N, 100 % used");
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_THAT(printed,
              testing::HasSubstr("palp-test warning: the budget of {} is 5 N, 100 % used"));
  EXPECT_EQ(printed.back(), '\n');
}

}  // namespace
}  // namespace palp::io
