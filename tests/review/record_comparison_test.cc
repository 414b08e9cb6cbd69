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

TEST(RecordComparisonTest, NamesTheNumberOfAModelThatChanged) {
  RecordComparison comparison{link::Role::Patient};
  const auto named = [&](auto change) {
    ModelPayload model{.version = 3};
    for (double& c : model.c) c = 0.25;
    for (double& stiffness : model.stiffness) stiffness = 100;
    SiteTick there = tick_at(TimePoint{2ms}, 0);
    there.sent.payload = model;
    change(model);
    SiteTick again = there;
    again.sent.payload = model;
    return comparison.compare({there}, {again}, TimePoint{});
  };
  const std::string at = "patient/tick, 0.002000 s, ";
  EXPECT_EQ(named([](ModelPayload& of) { of.c[1] = 0.5; }), at + "model_c2_n: 0.25 became 0.5");
  EXPECT_EQ(named([](ModelPayload& of) { of.c[4] = 0.5; }), at + "model_c5_n: 0.25 became 0.5");
  EXPECT_EQ(named([](ModelPayload& of) { of.stiffness[11] = 50; }),
            at + "model_stiffness12_n_per_m: 100 became 50");
  EXPECT_EQ(named([](ModelPayload& of) { of.swing_rate = 2; }),
            at + "model_swing_rad_per_s: 0 became 2");
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
