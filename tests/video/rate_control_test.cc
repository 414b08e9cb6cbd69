#include "video/rate_control.h"

#include <gtest/gtest.h>

namespace palp::video {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kRoundTrip = milliseconds{75};

TimePoint report_for(RateControl& rate, TimePoint from, Duration span, Duration standing) {
  Report report;
  report.standing_10us = static_cast<std::int16_t>(standing / std::chrono::microseconds{10});
  TimePoint at = from;
  for (; at < from + span; at += milliseconds{33}) rate.hear(report, kRoundTrip, at);
  return at;
}

TEST(RateControlTest, GrowsOnAnEmptyLineToItsMost) {
  RateControl rate{{}};
  report_for(rate, TimePoint{}, seconds{10}, Duration{0});
  EXPECT_EQ(rate.target(), 1000);
  EXPECT_EQ(rate.stride(), 1);
}

TEST(RateControlTest, YieldsOnceARoundTripToAStandingDelay) {
  RateControl rate{{}};
  const TimePoint now = report_for(rate, TimePoint{}, seconds{10}, Duration{0});
  report_for(rate, now, milliseconds{100}, milliseconds{5});
  EXPECT_NEAR(rate.target(), 850, 1e-9);
  report_for(rate, now + milliseconds{300}, milliseconds{30}, milliseconds{9});
  EXPECT_NEAR(rate.target(), 510, 1e-9);
}

TEST(RateControlTest, PausesFramesWhereTheDelayIsLong) {
  RateControl rate{{}};
  report_for(rate, TimePoint{}, milliseconds{20}, milliseconds{16});
  EXPECT_TRUE(rate.holds(TimePoint{milliseconds{39}}));
  EXPECT_FALSE(rate.holds(TimePoint{milliseconds{41}}));
}

TEST(RateControlTest, IsOffWhereItsLeastIsTooMuchAndLongerEachTime) {
  RateControl rate{{}};
  TimePoint now = report_for(rate, TimePoint{}, seconds{4}, milliseconds{9});
  ASSERT_TRUE(rate.off(now));
  TimePoint on = now;
  while (rate.off(on)) on += milliseconds{10};
  EXPECT_LE(on - now, seconds{5});
  now = report_for(rate, on, seconds{4}, milliseconds{9});
  ASSERT_TRUE(rate.off(now));
  TimePoint again = now;
  while (rate.off(again)) again += milliseconds{10};
  EXPECT_GT(again - now, seconds{5});
  EXPECT_LE(again - now, seconds{10});
}

TEST(RateControlTest, ThePaceRisesQuicklyUntilALineIsMet) {
  RateControl rate{{}};
  Report report;
  TimePoint now{};
  for (int i = 0; i < 75; ++i, now += milliseconds{33}) rate.hear(report, kRoundTrip, now);
  EXPECT_EQ(rate.pace(), 9600) << "within 2.5 s";
  report.span_ratio = 400;
  report.rate_kbps = 3000;
  rate.hear(report, kRoundTrip, now);
  report.span_ratio = 256;
  for (int i = 0; i < 30; ++i, now += milliseconds{33}) rate.hear(report, kRoundTrip, now);
  EXPECT_LT(rate.pace(), 4500) << "and slowly from then on";
}

TEST(RateControlTest, ALineSlowerThanThePaceSlowsIt) {
  RateControl rate{{}};
  Report report;
  TimePoint now{};
  for (int i = 0; i < 400; ++i, now += milliseconds{33}) rate.hear(report, kRoundTrip, now);
  EXPECT_EQ(rate.pace(), 9600);
  report.span_ratio = 400;
  report.rate_kbps = 3000;
  rate.hear(report, kRoundTrip, now);
  EXPECT_NEAR(rate.pace(), 0.85 * 3000, 1e-9);
}

TEST(ParityPlanTest, FollowsTheLossAndItsBursts) {
  ParityPlan plan;
  EXPECT_EQ(plan.count(4, 0, kRoundTrip), 0U);
  EXPECT_EQ(plan.count(4, 0.01, kRoundTrip), 1U);
  EXPECT_EQ(plan.count(4, 0.03, kRoundTrip), 2U);
  EXPECT_EQ(plan.count(4, 0.05, kRoundTrip), 3U);
  EXPECT_LT(plan.count(4, 0.03, milliseconds{20}), plan.count(4, 0.03, milliseconds{1000}))
      << "far away a frame that fails costs more";
  Report report;
  report.fragments_lost = 3;
  plan.hear(report);
  EXPECT_EQ(plan.count(4, 0, kRoundTrip), 3U);
  EXPECT_EQ(plan.count(1, 0, kRoundTrip), 2U) << "one more than the data at most";
}

}  // namespace
}  // namespace palp::video
