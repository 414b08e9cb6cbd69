#include "video/touch_hold.h"

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::video {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

/// Pictures, 30 a second, each so much older than force as `behind` says.
template <class Behind>
TimePoint pass(TouchHold& hold, TimePoint from, Duration span, Duration way, Behind behind) {
  for (TimePoint at = from; at < from + span; at += 33ms) {
    hold.add(way + behind(), way);
    (void)hold.wanted(at);
  }
  return from + span;
}

TEST(TouchHoldTest, ReachesWhat19Of20PicturesTakeAndAsMuchAsShowingTakes) {
  const RandomStream draws{1, 1};
  std::uint64_t i = 0;
  for (const Duration way : {Duration{0}, Duration{40ms}, Duration{300ms}}) {
    TouchHold hold;
    const TimePoint now = pass(hold, TimePoint{1s}, 12s, way, [&] {
      return from_seconds(0.010 + 0.020 * draws.uniform(i++));
    });
    const double wanted = seconds(hold.wanted(now) - TouchHold::kShowing);
    EXPECT_NEAR(wanted, 0.010 + 0.95 * 0.020, 2e-3) << seconds(way);
  }
}

TEST(TouchHoldTest, IsBounded) {
  TouchHold hold;
  TimePoint now = pass(hold, TimePoint{1s}, 12s, 10ms, [] { return Duration{3s}; });
  EXPECT_EQ(hold.wanted(now), TouchHold::kMax);
  now = pass(hold, now, 12s, 10ms, [] { return -Duration{3s}; });
  EXPECT_EQ(hold.wanted(now), Duration{0});
}

TEST(TouchHoldTest, WithoutPicturesThereIsNothingToBeInStepWith) {
  TouchHold hold;
  EXPECT_EQ(hold.wanted(TimePoint{1s}), Duration{0});
  const TimePoint now = pass(hold, TimePoint{1s}, 3s, 10ms, [] { return Duration{20ms}; });
  EXPECT_GT(hold.wanted(now + 1s), Duration{0});
  EXPECT_EQ(hold.wanted(now + 4s), Duration{0});
}

}  // namespace
}  // namespace palp::video
