#include "common/core/watchdog.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

TEST(WatchdogTest, GapOfExactlyTheHoldTimeIsStillLive) {
  EXPECT_EQ(judge_gap({}, nanoseconds{0}), LinkState::Live);
  EXPECT_EQ(judge_gap({}, milliseconds{100}), LinkState::Live);
  EXPECT_EQ(judge_gap({}, milliseconds{100} + nanoseconds{1}), LinkState::Hold);
}

TEST(WatchdogTest, GapOfExactlyTheLossTimeIsStillHold) {
  EXPECT_EQ(judge_gap({}, milliseconds{500}), LinkState::Hold);
  EXPECT_EQ(judge_gap({}, milliseconds{500} + nanoseconds{1}), LinkState::Lost);
}

TEST(WatchdogTest, BordersComeFromTheConfiguration) {
  const WatchdogConfig config{.hold_after = milliseconds{3}, .lost_after = milliseconds{7}};
  EXPECT_EQ(judge_gap(config, milliseconds{3}), LinkState::Live);
  EXPECT_EQ(judge_gap(config, milliseconds{4}), LinkState::Hold);
  EXPECT_EQ(judge_gap(config, milliseconds{8}), LinkState::Lost);
}

RC_GTEST_PROP(WatchdogTest, LongerGapIsNeverABetterLink, ()) {
  const nanoseconds shorter{*rc::gen::inRange<std::int64_t>(0, 1'000'000'000)};
  const nanoseconds longer = shorter + nanoseconds{*rc::gen::inRange<std::int64_t>(0, 600'000'000)};
  RC_ASSERT(judge_gap({}, shorter) <= judge_gap({}, longer));
}

}  // namespace
}  // namespace palp
