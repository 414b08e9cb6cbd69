#include "netem/relay/release_timing.h"

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

using std::chrono::microseconds;

TEST(ReleaseTimingTest, TheLeadGoesToWhatHalfOfTheCallsTake) {
  ReleaseTiming timing{TimePoint{}};
  for (int i = 0; i < 2000; ++i) timing.sent(i % 10 == 0 ? microseconds{900} : microseconds{8});
  EXPECT_NEAR(static_cast<double>(timing.lead(1).count()), 8000, 500);
  for (int i = 0; i < 2000; ++i) timing.sent(microseconds{900});
  EXPECT_EQ(timing.lead(1), ReleaseTiming::kLeadMax);
}

TEST(ReleaseTimingTest, OfSeveralTheMiddleOneIsOnTime) {
  ReleaseTiming timing{TimePoint{}};
  for (int i = 0; i < 2000; ++i) timing.sent(microseconds{10});
  EXPECT_EQ(timing.lead(0), timing.lead(1));
  EXPECT_EQ(timing.lead(3), 2 * timing.lead(1));
  EXPECT_EQ(timing.lead(64), ReleaseTiming::kBunchLeadMax);
}

TEST(ReleaseTimingTest, TheSpinGrowsAtOnceAndShrinksSlowlyWithinItsLimits) {
  ReleaseTiming timing{TimePoint{}};
  EXPECT_EQ(timing.spin(), ReleaseTiming::kSpinMin);
  timing.woken(microseconds{200});
  EXPECT_EQ(timing.spin(), microseconds{220});
  timing.woken(microseconds{10});
  EXPECT_GT(timing.spin(), microseconds{218});
  EXPECT_LT(timing.spin(), microseconds{220});
  timing.woken(std::chrono::seconds{1});
  EXPECT_EQ(timing.spin(), ReleaseTiming::kSpinMax);
  for (int i = 0; i < 5000; ++i) timing.woken(microseconds{10});
  EXPECT_NEAR(static_cast<double>(timing.spin().count()), 60'000, 200);
}

TEST(ReleaseTimingTest, AwakeCountsFromTheLastSleep) {
  ReleaseTiming timing{TimePoint{microseconds{5}}};
  EXPECT_EQ(timing.awake(TimePoint{microseconds{9}}), microseconds{4});
  timing.slept(TimePoint{microseconds{8}});
  EXPECT_EQ(timing.awake(TimePoint{microseconds{9}}), microseconds{1});
}

}  // namespace
}  // namespace palp::netem
