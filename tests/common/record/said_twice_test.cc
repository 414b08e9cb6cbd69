#include "common/record/said_twice.h"

#include <gtest/gtest.h>

namespace palp::record {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

/// A tick with two samples, the earlier one of them fresh: it came 400 us before the tick.
PatientFileTick sample_tick() {
  PatientFileTick made;
  made.at = TimePoint{70ms};
  made.tick.round_trip = made.given.heard.round_trip = 21ms;
  made.given.heard.gap = 400us;
  made.given.samples = 2;
  made.given.earlier.incoming.fresh = true;
  made.given.earlier.incoming.arrived_at = made.at - 400us;
  made.given.arrived.incoming.arrived_at = made.at - 100us;
  return made;
}

TEST(SaidTwiceTest, WhatIsLeftOutComesBack) {
  PatientFileTick tick = sample_tick();
  ASSERT_TRUE(leave_out(tick));
  EXPECT_EQ(tick.given.heard.round_trip, 0ms);
  EXPECT_EQ(tick.given.earlier.incoming.arrived_at, TimePoint{});
  EXPECT_EQ(tick.given.arrived.incoming.arrived_at, tick.at - 100us) << "of a late one it is said";
  put_back(tick);
  EXPECT_EQ(tick.given.heard.round_trip, 21ms);
  EXPECT_EQ(tick.given.earlier.incoming.arrived_at, tick.at - 400us);
  EXPECT_EQ(tick.given.arrived.incoming.arrived_at, tick.at - 100us);
}

TEST(SaidTwiceTest, OfTwoFreshSamplesItIsTheLast) {
  PatientFileTick tick = sample_tick();
  tick.given.arrived.incoming.fresh = true;
  tick.given.arrived.incoming.arrived_at = tick.at - 400us;
  tick.given.earlier.incoming.arrived_at = tick.at - 900us;
  ASSERT_TRUE(leave_out(tick));
  EXPECT_EQ(tick.given.earlier.incoming.arrived_at, tick.at - 900us);
  put_back(tick);
  EXPECT_EQ(tick.given.arrived.incoming.arrived_at, tick.at - 400us);
}

TEST(SaidTwiceTest, WhatDoesNotFollowStays) {
  PatientFileTick trip = sample_tick();
  trip.tick.round_trip = 22ms;
  EXPECT_FALSE(leave_out(trip));
  EXPECT_EQ(trip.given.heard.round_trip, 21ms);
  PatientFileTick sample = sample_tick();
  sample.given.earlier.incoming.arrived_at += 1us;
  EXPECT_FALSE(leave_out(sample));
  EXPECT_EQ(sample.given.heard.round_trip, 21ms);
  EXPECT_EQ(sample.given.earlier.incoming.arrived_at, sample.at - 399us);
}

TEST(SaidTwiceTest, WithoutAFreshSampleNoneIsTouched) {
  PatientFileTick tick = sample_tick();
  tick.given.samples = 1;
  ASSERT_TRUE(leave_out(tick));
  put_back(tick);
  EXPECT_EQ(tick.given.arrived.incoming.arrived_at, tick.at - 100us);
}

}  // namespace
}  // namespace palp::record
