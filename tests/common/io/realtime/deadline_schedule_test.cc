#include "common/io/realtime/deadline_schedule.h"

#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::io {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr TimePoint kFirst{milliseconds{10}};
constexpr Duration kPeriod = milliseconds{1};

/// One tick that begins `late` after its deadline and takes `work`.
void run_tick(DeadlineSchedule& schedule, Duration late, Duration work) {
  const TimePoint began_at = schedule.deadline() + late;
  schedule.begin(began_at);
  schedule.end(began_at + work);
}

TEST(DeadlineScheduleTest, PunctualTicksComeAPeriodApart) {
  DeadlineSchedule schedule{kFirst, kPeriod};
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(schedule.deadline(), kFirst + i * kPeriod);
    run_tick(schedule, microseconds{3}, microseconds{200});
  }
  EXPECT_EQ(schedule.progress().ticks, 1000U);
  EXPECT_EQ(schedule.progress().missed, 0U);
  EXPECT_EQ(schedule.progress().overruns, 0U);
  EXPECT_EQ(schedule.progress().lateness_max, microseconds{3});
}

TEST(DeadlineScheduleTest, OverrunSkipsThePeriodsItCoveredAndNeverCatchesUp) {
  DeadlineSchedule schedule{kFirst, kPeriod};
  run_tick(schedule, Duration{0}, microseconds{3500});
  EXPECT_EQ(schedule.progress().missed, 3U);
  EXPECT_EQ(schedule.progress().overruns, 1U);
  EXPECT_EQ(schedule.deadline(), kFirst + 4 * kPeriod);
}

TEST(DeadlineScheduleTest, LateWakeIsMissedButNotAnOverrun) {
  DeadlineSchedule schedule{kFirst, kPeriod};
  run_tick(schedule, microseconds{2400}, microseconds{100});
  EXPECT_EQ(schedule.progress().missed, 2U);
  EXPECT_EQ(schedule.progress().overruns, 0U);
  EXPECT_EQ(schedule.progress().lateness_max, microseconds{2400});
  EXPECT_EQ(schedule.deadline(), kFirst + 3 * kPeriod);
}

TEST(DeadlineScheduleTest, TickThatEndsExactlyAtTheNextDeadlineMissesNothing) {
  DeadlineSchedule schedule{kFirst, kPeriod};
  run_tick(schedule, Duration{0}, kPeriod);
  EXPECT_EQ(schedule.progress().missed, 0U);
  EXPECT_EQ(schedule.progress().overruns, 0U);
  EXPECT_EQ(schedule.deadline(), kFirst + kPeriod);
  run_tick(schedule, Duration{0}, kPeriod + Duration{1});
  EXPECT_EQ(schedule.progress().missed, 1U);
  EXPECT_EQ(schedule.progress().overruns, 1U);
}

RC_GTEST_PROP(DeadlineScheduleTest, EveryPeriodIsEitherTickedOrMissedAndNoDeadlineIsInThePast, ()) {
  DeadlineSchedule schedule{kFirst, kPeriod};
  const auto steps = *rc::gen::container<std::vector<std::pair<int, int>>>(
      rc::gen::pair(rc::gen::inRange(0, 5'000'000), rc::gen::inRange(0, 5'000'000)));
  for (const auto& [late, work] : steps) {
    const TimePoint ended_at = schedule.deadline() + Duration{late} + Duration{work};
    run_tick(schedule, Duration{late}, Duration{work});
    RC_ASSERT(schedule.deadline() >= ended_at);
    RC_ASSERT((schedule.deadline() - kFirst) % kPeriod == Duration{0});
  }
  const auto periods = static_cast<std::uint64_t>((schedule.deadline() - kFirst) / kPeriod);
  RC_ASSERT(schedule.progress().ticks + schedule.progress().missed == periods);
  RC_ASSERT(schedule.lateness().count() == schedule.progress().ticks);
}

}  // namespace
}  // namespace palp::io
