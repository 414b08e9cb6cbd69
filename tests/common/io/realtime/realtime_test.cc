#include "common/io/realtime/realtime.h"

#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

namespace palp::io {
namespace {

using testing::HasSubstr;

/// On a thread of its own: a priority stays with the thread.
RealtimeGrant request(int priority, bool lock_memory, const RealtimeLimits& limits) {
  RealtimeGrant grant;
  std::jthread{[&] { grant = request_realtime(priority, lock_memory, limits); }}.join();
  return grant;
}

TEST(RealtimeTest, FiniteMemoryLimitIsNotLockedUnder) {
  const RealtimeLimits poor{.priority_max = 0, .memory_unlimited = false, .memory_limit = "64 KiB"};
  const RealtimeGrant grant = request(0, true, poor);
  EXPECT_FALSE(grant.memory_locked);
  EXPECT_THAT(grant.memory, HasSubstr("the limit (ulimit -l) is 64 KiB"));
  // Had it been locked for the future, 64 MiB more would not be had.
  const std::vector<char> much(64UL << 20U, 'x');
  EXPECT_EQ(much.back(), 'x');
}

TEST(RealtimeTest, WithoutTheRightItStaysOrdinaryAndSaysWhy) {
  const RealtimeGrant grant = request(80, false, {});
  EXPECT_EQ(grant.priority, 0);
  EXPECT_EQ(grant.scheduling,
            "SCHED_FIFO 80 not granted: RLIMIT_RTPRIO is 0 and CAP_SYS_NICE is missing");
}

TEST(RealtimeTest, AsksForNothingItWasNotAskedFor) {
  const RealtimeGrant grant = request(0, false, read_realtime_limits());
  EXPECT_EQ(grant.priority, 0);
  EXPECT_FALSE(grant.memory_locked);
}

TEST(RealtimeTest, TakesWhatTheLimitsAllowAndCanStillAllocate) {
  const RealtimeGrant grant = request(80, true, read_realtime_limits());
  EXPECT_FALSE(grant.scheduling.empty());
  EXPECT_FALSE(grant.memory.empty());
  const std::vector<char> much(64UL << 20U, 'x');
  EXPECT_EQ(much.back(), 'x');
  munlockall();
}

TEST(RealtimeTest, LowerPriorityIsTakenWhereTheLimitEndsBelow) {
  RealtimeLimits limits = read_realtime_limits();
  limits.priority_max = std::min(limits.priority_max, 10);
  const RealtimeGrant grant = request(80, false, limits);
  EXPECT_LE(grant.priority, 10);
}

}  // namespace
}  // namespace palp::io
