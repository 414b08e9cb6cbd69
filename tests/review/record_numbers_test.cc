#include "review/record_numbers.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace palp::review {
namespace {

std::string text_of(const Record& record, link::Role site, const std::string& name) {
  const NamedNumbers numbers = numbers_of(record, site);
  const auto found = std::ranges::find(numbers, name, &NamedNumber::name);
  return found == numbers.end() ? "none" : found->text();
}

TEST(RecordNumbersTest, NamesAreThoseOfTheSitesSchema) {
  SiteTick tick;
  tick.position = 1.5e-3;
  tick.command = 0.25;
  EXPECT_EQ(text_of(tick, link::Role::Surgeon, "position_m"), "0.0015");
  EXPECT_EQ(text_of(tick, link::Role::Surgeon, "command_n"), "0.25");
  EXPECT_EQ(text_of(tick, link::Role::Patient, "command_m"), "0.25");
  EXPECT_EQ(text_of(tick, link::Role::Patient, "command_n"), "none");
}

TEST(RecordNumbersTest, WholeNumbersKeepAllTheirDigits) {
  LinkHeard heard;
  heard.session_id = 0xffff'ffff'ffff'fffeU;
  EXPECT_EQ(text_of(heard, link::Role::Surgeon, "session_id"), "18446744073709551614");
}

TEST(RecordNumbersTest, AreEqualToTheBit) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ((NamedNumber{"a", nan}), (NamedNumber{"a", nan}));
  EXPECT_FALSE((NamedNumber{"a", 0.0} == NamedNumber{"a", -0.0}));
  EXPECT_FALSE((NamedNumber{"a", 1.0} == NamedNumber{"b", 1.0}));
}

TEST(RecordNumbersTest, AnEstimatesInstantIsItsStrokesEnd) {
  const TimePoint end{Duration{7}};
  DepthEstimate estimate;
  estimate.stroke_ended_at = end;
  EXPECT_EQ(instant_of(estimate), end);
  SiteTick tick;
  tick.at = end;
  EXPECT_EQ(instant_of(tick), end);
}

}  // namespace
}  // namespace palp::review
