#include "common/io/realtime/periodic_loop.h"

#include <vector>

#include <gtest/gtest.h>

#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;

/// Keeps the thread busy until `span` has passed.
void work_for(Duration span) {
  const SteadyClock clock;
  const TimePoint until = clock.now() + span;
  while (clock.now() < until) {
  }
}

TEST(PeriodicLoopTest, TicksComeInOrderAndNeverBeforeTheirDeadline) {
  std::vector<TimePoint> ticks;
  ticks.reserve(64);
  std::stop_source stop;
  const LoopStats stats = run_periodic(
      {},
      [&](TimePoint now) {
        ticks.push_back(now);
        if (ticks.size() == 50) {
          stop.request_stop();
        }
      },
      stop.get_token());
  ASSERT_EQ(stats.ticks, 50U);
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    EXPECT_GT(ticks[i], ticks[i - 1]);
  }
  const Duration least = static_cast<std::int64_t>(49 + stats.missed) * milliseconds{1};
  EXPECT_GE(ticks.back() - ticks.front(), least - stats.lateness_max);
}

TEST(PeriodicLoopTest, CountsWhatALongTickCosts) {
  std::stop_source stop;
  int ticks = 0;
  const LoopStats stats = run_periodic(
      {},
      [&](TimePoint) {
        ++ticks;
        if (ticks == 2) {
          work_for(milliseconds{5});
        }
        if (ticks == 4) {
          stop.request_stop();
        }
      },
      stop.get_token());
  EXPECT_EQ(stats.ticks, 4U);
  EXPECT_GE(stats.missed, 4U);
  EXPECT_GE(stats.overruns, 1U);
}

TEST(PeriodicLoopTest, WarmsUpAtMostOncePerPeriodAndBeforeItsTick) {
  std::stop_source stop;
  int ticks = 0;
  int warm_ups = 0;
  int since_tick = 0;
  int most = 0;
  run_periodic({.spin = std::chrono::microseconds{500}},
               [&](TimePoint) {
                 ++ticks;
                 since_tick = 0;
                 if (ticks >= 20 && (warm_ups > 0 || ticks > 10'000)) stop.request_stop();
               },
               stop.get_token(),
               {.warm_up = [&] {
                 ++warm_ups;
                 most = std::max(most, ++since_tick);
               }});
  EXPECT_GT(warm_ups, 0);
  EXPECT_EQ(most, 1);
  EXPECT_LE(warm_ups, ticks);
}

TEST(PeriodicThreadTest, TellsItsGrantAtOnceAndItsProgressWhileItRuns) {
  Mailbox<int> seen;  // writer: loop, reader: test
  int count = 0;
  PeriodicThread loop{"test-loop", {.priority = 0}, [&](TimePoint) { seen.put(++count); }};
  EXPECT_EQ(loop.grant().scheduling, "ordinary scheduling, as asked");
  const SteadyClock clock;
  const TimePoint deadline = clock.now() + std::chrono::seconds{20};
  while ((loop.progress().ticks < 5 || seen.get() < 5) && clock.now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_GE(loop.progress().ticks, 5U);
  const LoopStats stats = loop.stop();
  EXPECT_EQ(stats.ticks, static_cast<std::uint64_t>(count));
  EXPECT_EQ(loop.stop().ticks, stats.ticks);
}

TEST(PeriodicLoopTest, FlushesDenormalsAroundTicksOnly) {
  std::stop_source stop;
  double tiny = 1;
  volatile double smallest = std::numeric_limits<double>::min();
  run_periodic(
      {},
      [&](TimePoint) {
        tiny = smallest * 0.5;
        stop.request_stop();
      },
      stop.get_token());
  EXPECT_EQ(tiny, 0.0);
  EXPECT_NE(smallest * 0.5, 0.0);
}

}  // namespace
}  // namespace palp::io
