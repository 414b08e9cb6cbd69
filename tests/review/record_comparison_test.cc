#include "review/record_comparison.h"

#include <gtest/gtest.h>

namespace palp::review {
namespace {

using std::chrono_literals::operator""ms;

SiteTick tick_at(TimePoint at, double force) {
  SiteTick tick;
  tick.at = at;
  tick.force = force;
  return tick;
}

TEST(RecordComparisonTest, NamesTopicTimeAndField) {
  RecordComparison comparison{link::Role::Surgeon};
  const TimePoint at{1500ms};
  const std::vector<Record> there{tick_at(at, 0.5)};
  EXPECT_EQ(comparison.compare(there, there, TimePoint{}), "");
  EXPECT_EQ(comparison.compare(there, {tick_at(at, 0.25)}, TimePoint{500ms}),
            "surgeon/tick, 1.000000 s, force_n: 0.5 became 0.25");
}

TEST(RecordComparisonTest, NamesARecordThatIsMissingOrTooMuch) {
  RecordComparison comparison{link::Role::Patient};
  const Record tick = tick_at(TimePoint{2ms}, 0);
  EXPECT_EQ(comparison.compare({tick}, {}, TimePoint{}),
            "patient/tick, 0.002000 s, the whole record: it did not come again");
  EXPECT_EQ(comparison.compare({}, {tick}, TimePoint{}),
            "patient/tick, 0.002000 s, the whole record: the file has none");
  EXPECT_EQ(comparison.compare({tick}, {Note{.at = TimePoint{2ms}}}, TimePoint{}),
            "patient/tick, 0.002000 s, the whole record: it became 'note'");
}

}  // namespace
}  // namespace palp::review
