#include "netem/model/path_conditions.h"

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr TimePoint kStart{seconds{100}};

/// Goal: nobody need be asked while it is calm. Method: one is asked about each datagram, one about
/// those only that come in troubled times, while the law changes; they say the same.
TEST(PathConditionsTest, WhoIsAskedOnlyInTroubleSaysWhatWhoIsAlwaysAskedSays) {
  Impairment law;
  law.burst = {.rate = 0.5, .length = milliseconds{30}};
  law.gilbert = {.good = seconds{1}, .bad = milliseconds{50}};
  law.stall = {.rate = 0.5, .median = milliseconds{40}, .spread = 0.3};
  law.blackouts = {{seconds{2}, milliseconds{100}}, {seconds{20}, milliseconds{100}}};
  const Impairment plain;
  const Streams streams{5, Direction::Down};
  PathConditions always{law, streams, kStart};
  PathConditions seldom{law, streams, kStart};
  int calm = 0;
  for (std::uint64_t index = 0; index < 30'000; ++index) {
    const TimePoint at = kStart + milliseconds{index};
    for (PathConditions* path : {&always, &seldom}) {
      if (index == 0 || index == 14'000) path->change(law, at);
      if (index == 12'000) path->change(plain, at);
    }
    const PathCondition said = always.at(at, index);
    if (seldom.calm(at)) {
      ++calm;
      ASSERT_EQ(said, PathCondition{.onward = at}) << index;
    } else {
      ASSERT_EQ(seldom.at(at, index), said) << index;
    }
  }
  EXPECT_GT(calm, 15'000);
}

TEST(PathConditionsTest, ABlackoutIsDarkFromItsBeginToBeforeItsEnd) {
  Impairment law;
  law.blackouts = {{milliseconds{10}, milliseconds{5}}};
  PathConditions path{law, Streams{5, Direction::Up}, kStart};
  const auto dark = [&](Duration since) { return path.at(kStart + since, 0).dark; };
  EXPECT_FALSE(dark(milliseconds{10} - Duration{1}));
  EXPECT_TRUE(dark(milliseconds{10}));
  EXPECT_TRUE(dark(milliseconds{15} - Duration{1}));
  EXPECT_FALSE(dark(milliseconds{15}));
  EXPECT_TRUE(path.calm(kStart + seconds{1000}));
}

TEST(PathConditionsTest, TheBitmapComesRoundAndIsNeverCalm) {
  Impairment law;
  law.bitmap.lost = {false, true, false};
  PathConditions path{law, Streams{5, Direction::Up}, kStart};
  for (std::uint64_t index = 0; index < 9; ++index) {
    EXPECT_FALSE(path.calm(kStart));
    EXPECT_EQ(path.at(kStart, index).lost, index % 3 == 1) << index;
  }
}

}  // namespace
}  // namespace palp::netem
