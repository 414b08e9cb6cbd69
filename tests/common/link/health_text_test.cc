#include "common/link/health_text.h"

#include <gtest/gtest.h>

namespace palp::link {
namespace {

using std::chrono_literals::operator""us;
using std::chrono_literals::operator""ms;

LinkHealth live() {
  LinkHealth health;
  health.state = LinkState::Live;
  health.round_trip = 75'130us;
  health.accepted = 990;
  health.lost = 10;
  return health;
}

TEST(HealthTextTest, SaysRoundTripAndLoss) {
  EXPECT_EQ(health_text(live()), "rtt 75.1 ms  loss 1.0 %");
  EXPECT_EQ(health_text({}), "no link");
}

TEST(HealthTextTest, SaysTheWaysOnceTheClockIsKnown) {
  LinkHealth health = live();
  health.peer_clock = ClockOffset{};
  health.delay_out = 37'900us;
  health.delay_in = 37'230us;
  EXPECT_EQ(health_text(health), "rtt 75.1 ms (there 37.9, here 37.2)  loss 1.0 %");
}

TEST(HealthTextTest, InBriefTheRoundTripOrTheSilence) {
  LinkHealth health = live();
  EXPECT_EQ(health_brief(health), "rtt 75.1 ms");
  health.state = LinkState::Hold;
  health.gap = 320ms;
  EXPECT_EQ(health_brief(health), "silent 0.3 s");
  EXPECT_EQ(health_brief({}), "no link");
}

TEST(HealthTextTest, SaysForHowLongNothingCame) {
  LinkHealth health = live();
  health.state = LinkState::Hold;
  health.gap = 320ms;
  EXPECT_EQ(health_text(health), "rtt 75.1 ms  loss 1.0 %  silent 0.3 s");
}

}  // namespace
}  // namespace palp::link
