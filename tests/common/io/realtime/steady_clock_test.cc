#include "common/io/realtime/steady_clock.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(SteadyClockTest, NeverGoesBackAndSleepsNotTooShort) {
  const SteadyClock clock;
  const TimePoint begin = clock.now();
  clock.sleep_until(begin + std::chrono::milliseconds{2});
  const TimePoint end = clock.now();
  EXPECT_GE(end - begin, std::chrono::milliseconds{2});
  clock.sleep_until(begin);
  clock.sleep_until(TimePoint{});
  EXPECT_GE(clock.now(), end);
}

}  // namespace
}  // namespace palp::io
