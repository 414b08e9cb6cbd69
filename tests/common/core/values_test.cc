#include <cstdint>
#include <set>
#include <string_view>
#include <type_traits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/result.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/message/depth.h"
#include "common/message/port_sample.h"

namespace palp {
namespace {

template <class Left, class Right>
concept Subtractable = requires(Left left, Right right) {
  left - right;
};

TEST(TimeTest, LinesOfTwoSitesDoNotMix) {
  static_assert(Subtractable<TimePoint, TimePoint>);
  static_assert(!Subtractable<TimePoint, PeerTimePoint>);
  static_assert(!std::is_convertible_v<PeerTimePoint, TimePoint>);
  SUCCEED();
}

RC_GTEST_PROP(TimeTest, SecondsAndBackIsTheIdentityForAYear, ()) {
  const Duration span{
      *rc::gen::inRange<std::int64_t>(-4'000'000'000'000'000, 4'000'000'000'000'000)};
  RC_ASSERT(from_seconds(seconds(span)) == span);
}

TEST(TimeTest, ElapsedIsTheDifferenceAndStaysAtTheBordersWhereThatDoesNotFit) {
  const auto at = [](std::int64_t count) { return TimePoint{Duration{count}}; };
  EXPECT_EQ(elapsed(at(5), at(12)), Duration{7});
  EXPECT_EQ(elapsed(at(12), at(5)), Duration{-7});
  EXPECT_EQ(elapsed(TimePoint::min(), at(1)), Duration::max());
  EXPECT_EQ(elapsed(at(1), TimePoint::min()), Duration::min());
  EXPECT_EQ(elapsed(TimePoint::max(), at(-2)), Duration::min());
}

TEST(TimeTest, FromSecondsRoundsToTheNearestOnBothSidesOfZero) {
  EXPECT_EQ(from_seconds(1.4e-9).count(), 1);
  EXPECT_EQ(from_seconds(1.6e-9).count(), 2);
  EXPECT_EQ(from_seconds(-1.4e-9).count(), -1);
  EXPECT_EQ(from_seconds(-1.6e-9).count(), -2);
}

/// Every value has a name of its own, and what is no value is no crash.
template <class Enumeration>
void expect_names(int count) {
  std::set<std::string_view> names;
  for (int i = 0; i < count; ++i) names.insert(to_string(static_cast<Enumeration>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(count));
  EXPECT_FALSE(names.contains("?"));
  EXPECT_EQ(to_string(static_cast<Enumeration>(count)), "?");
}

TEST(NamesTest, EveryStateVerdictAndReasonHasItsOwnName) {
  expect_names<SiteState>(kSiteStateCount);
  expect_names<LinkState>(kLinkStateCount);
  expect_names<DepthVerdict>(kDepthVerdictCount);
  expect_names<DepthReason>(kDepthReasonCount);
}

TEST(DefaultsTest, NothingKnownMeansNothingClaimed) {
  EXPECT_EQ(DepthEstimate{}.verdict, DepthVerdict::Invalid);
  EXPECT_EQ(DepthEstimate{}.number, 0U);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(PortSample{}.payload));
  EXPECT_FALSE(Incoming{}.fresh);
  EXPECT_EQ(SiteState{}, SiteState::Parked);
  EXPECT_EQ(LinkState{}, LinkState::Down);
}

TEST(ResultTest, CarriesAValueOrASentence) {
  const Result<double> good{2 * kMillimetre};
  ASSERT_TRUE(good.has_value());
  EXPECT_EQ(*good, 0.002);
  const Result<double> bad = fail("depth_mm is 70, it must lie in 1 to 60");
  ASSERT_FALSE(bad.has_value());
  EXPECT_EQ(bad.error().text, "depth_mm is 70, it must lie in 1 to 60");
}

TEST(CheckDeathTest, NamesPlaceConditionAndWhatMustHold) {
  const int one = 1;
  PALP_CHECK(one == 1, "holds");
  EXPECT_DEATH(PALP_CHECK(one == 2, "one is two"),
               "values_test.cc:.*check failed: one is two .one == 2.");
}

}  // namespace
}  // namespace palp
