#include "site_program/status_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;

TEST(StatusLineTest, WhereNobodyWatchesItIsAPlainLineEveryTwoSeconds) {
  testing::internal::CaptureStdout();
  {
    StatusLine line;
    for (int tick = 0; tick <= 40; ++tick) {
      line.show("at " + std::to_string(tick), TimePoint{milliseconds{100 * tick}});
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "at 0\nat 20\nat 40\n");
}

}  // namespace
}  // namespace palp::site_program
