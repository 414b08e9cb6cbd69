#include "common/io/realtime/wall_clock.h"

#include <chrono>

#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

TEST(WallClockTest, IsTheSystemsTime) {
  const WallClockReading reading = read_wall_clock();
  const Duration told = SteadyClock{}.now().time_since_epoch() + reading.ahead;
  const Duration system = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_LT(std::chrono::abs(told - system), std::chrono::seconds{5}) << "whatever the load";
  EXPECT_LE(std::chrono::abs(reading.zone), std::chrono::hours{15});
}

}  // namespace
}  // namespace palp::io
