#include "common/core/lapse.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

TEST(LapseTest, ATickThatComesInTimePassedOnePeriodAndHeldNothing) {
  const Lapse lapse = 500us;
  EXPECT_EQ(lapse.passed(), lapse.period);
  EXPECT_FALSE(lapse.late());
  EXPECT_EQ(lapse.held(), 0);
}

TEST(LapseTest, WhatPassedIsWhatWasHeldAndOnePeriod) {
  for (const std::int64_t periods : {2, 50, 40'000}) {
    const Lapse lapse{1ms, periods};
    EXPECT_TRUE(lapse.late());
    EXPECT_DOUBLE_EQ(seconds(lapse.passed()), lapse.held() + seconds(lapse.period));
  }
}

TEST(LapseTest, TheSiteIsAtFaultBeforeThePeerHolds) {
  constexpr Duration kPeerHolds = 100ms;  // the watchdog's
  EXPECT_LT(kLateMax, kPeerHolds);
}

}  // namespace
}  // namespace palp
