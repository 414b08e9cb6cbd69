#include "common/io/realtime/background_loop.h"

#include <atomic>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(BackgroundLoopTest, WorksOnceMoreAfterStopWasAsked) {
  std::atomic<int> queued{0};
  int done = 0;
  BackgroundLoop loop{"test", hours{1}, [&](TimePoint) { done = queued.load(); }};
  queued = 7;
  loop.stop();
  EXPECT_EQ(done, 7);
}

TEST(BackgroundLoopTest, CallsAgainAfterEachPause) {
  std::atomic<int> calls{0};
  BackgroundLoop loop{"test", milliseconds{1}, [&](TimePoint) {
                        ++calls;
                        calls.notify_all();
                      }};
  for (int seen = calls; seen < 3; seen = calls) {
    calls.wait(seen);
  }
  loop.stop();
  EXPECT_GE(calls, 3);
}

TEST(BackgroundLoopTest, StopThrowsWhatTheWorkThrew) {
  BackgroundLoop loop{
      "test", milliseconds{1}, [](TimePoint) { throw std::runtime_error{"disk full"}; }};
  EXPECT_THROW(
      {
        try {
          loop.stop();
        } catch (const std::runtime_error& failure) {
          EXPECT_STREQ(failure.what(), "disk full");
          throw;
        }
      },
      std::runtime_error);
}

TEST(BackgroundLoopTest, AsksWhatTheWorkThrew) {
  std::atomic<bool> throws{false};
  BackgroundLoop loop{"test", milliseconds{1}, [&](TimePoint) {
                        if (throws) throw std::runtime_error{"out of ink"};
                      }};
  EXPECT_EQ(loop.failure(), std::nullopt);
  throws = true;
  while (!loop.failure()) SteadyClock{}.pass(milliseconds{1});
  EXPECT_EQ(loop.failure(), "out of ink");
  EXPECT_THROW(loop.stop(), std::runtime_error);
}

TEST(BackgroundLoopTest, WhatDoesNotComeBackIsLeftToItself) {
  static std::atomic<bool> in;
  static std::atomic<bool> out;
  static std::atomic<bool> done;
  {
    BackgroundLoop loop{"test", milliseconds{1}, [](TimePoint) {
                          in = true;
                          in.notify_all();
                          out.wait(false);
                          done = true;
                          done.notify_all();
                        }};
    in.wait(false);
    EXPECT_FALSE(loop.stop_within(milliseconds{1}));
  }
  EXPECT_FALSE(done) << "nobody waited for it";
  out = true;
  out.notify_all();
  done.wait(false);
}

TEST(BackgroundLoopTest, WhatComesBackInTimeHasWorkedOnceMore) {
  std::atomic<int> queued{0};
  int done = 0;
  BackgroundLoop loop{"test", hours{1}, [&](TimePoint) { done = queued.load(); }};
  queued = 7;
  EXPECT_TRUE(loop.stop_within(hours{1}));
  EXPECT_EQ(done, 7);
}

}  // namespace
}  // namespace palp::io
