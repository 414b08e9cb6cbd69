#include "common/record/wall_clock.h"

#include <gtest/gtest.h>

namespace palp::record {
namespace {

TEST(WallClockTest, UtcIsWrittenToTheNanosecond) {
  EXPECT_EQ(utc_text(0), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(utc_text(951'782'400'000'000'001), "2000-02-29T00:00:00.000000001Z");
}

TEST(WallClockTest, StampAndOwnTimeAreEachOthersInverse) {
  const WallClock clock{.ahead = Duration{1'700'000'000'000'000'007}};
  for (const std::int64_t own : {std::int64_t{0}, std::int64_t{123}, std::int64_t{-5}}) {
    EXPECT_EQ(clock.own(clock.stamp(TimePoint{Duration{own}})), TimePoint{Duration{own}});
  }
}

TEST(WallClockTest, ASessionsIdHasSixteenDigits) {
  EXPECT_EQ(session_id_text(0xab), "00000000000000ab");
}

}  // namespace
}  // namespace palp::record
