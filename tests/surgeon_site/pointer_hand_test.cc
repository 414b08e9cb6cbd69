#include "surgeon_site/pointer_hand.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/realtime_guard.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

/// A hand read each ms, whose finger reports each 16 ms while it is down.
struct Rig {
  PointerHand hand{PointerHandConfig{}};
  TimePoint now{1000s};
  PointerReport finger;
  bool reports{true};
  HandState state{hand.read(now)};

  void press() {
    ++finger.press;
    finger.held = true;
    finger.into = finger.x = finger.y = 0;
    tell();
  }
  void lift() {
    finger.held = false;
    tell();
  }
  void tell() {
    finger.arrived_at = now;
    hand.reports().put(finger);
  }
  void live(Duration span) {
    for (Duration t{}; t < span; t += 1ms) {
      now += 1ms;
      if (reports && finger.held && t % 16ms == 0ms) tell();
      state = hand.read(now);
    }
  }
};

TEST(PointerHandTest, ThePedalIsDownWhileTheFingerIs) {
  Rig rig;
  rig.live(50ms);
  EXPECT_FALSE(rig.state.pedal_held);
  rig.press();
  rig.live(1ms);
  EXPECT_TRUE(rig.state.pedal_held);
  rig.live(1s);
  EXPECT_TRUE(rig.state.pedal_held);
  rig.lift();
  rig.live(1ms);
  EXPECT_FALSE(rig.state.pedal_held);
}

TEST(PointerHandTest, AFingerThatFallsSilentIsUpAfter150Milliseconds) {
  Rig rig;
  rig.press();
  rig.live(100ms);
  rig.tell();
  rig.reports = false;
  rig.live(150ms);
  EXPECT_TRUE(rig.state.pedal_held) << "not before";
  rig.live(1ms);
  EXPECT_FALSE(rig.state.pedal_held);
}

TEST(PointerHandTest, APressThatWasOverNeverComesBack) {
  Rig rig;
  rig.press();
  rig.live(100ms);
  rig.reports = false;
  rig.live(200ms);
  rig.reports = true;
  rig.live(500ms);
  EXPECT_FALSE(rig.state.pedal_held) << "the page woke up; only a new press counts";
  rig.press();
  rig.live(2ms);
  EXPECT_TRUE(rig.state.pedal_held);
  rig.lift();
  rig.live(2ms);
  rig.finger.held = true;  // the same press once more
  rig.tell();
  rig.live(2ms);
  EXPECT_FALSE(rig.state.pedal_held);
}

TEST(PointerHandTest, AReportThatCameTooLateIsNoPress) {
  Rig rig;
  rig.press();  // heard of now, but read much later
  rig.now += 151ms;
  EXPECT_FALSE(rig.hand.read(rig.now).pedal_held);
  rig.tell();
  rig.live(2ms);
  EXPECT_FALSE(rig.state.pedal_held);
}

TEST(PointerHandTest, BetweenTwoPressesThePedalIsSeenUp) {
  Rig rig;
  rig.press();
  rig.live(50ms);
  rig.press();  // its end was overwritten in the mailbox
  rig.live(1ms);
  EXPECT_FALSE(rig.state.pedal_held);
  rig.live(1ms);
  EXPECT_TRUE(rig.state.pedal_held);
}

TEST(PointerHandTest, TheHandGoesWhereTheFingerIsDrawn) {
  Rig rig;
  rig.live(100ms);
  const HandState before = rig.state;
  rig.press();
  rig.finger.into = 0.005;
  rig.finger.x = 0.010;
  rig.finger.y = -0.002;
  rig.live(2s);
  EXPECT_NEAR(rig.state.position - before.position, 0.005, 0.1e-3);
  EXPECT_NEAR(rig.state.place.x - before.place.x, 0.010, 1e-6);
  EXPECT_NEAR(rig.state.place.y - before.place.y, -0.002, 1e-6);
  rig.lift();
  rig.live(10ms);
  const HandState after = rig.state;
  rig.press();
  rig.live(500ms);
  EXPECT_NEAR(rig.state.position, after.position, 0.1e-3) << "a press begins where the hand is";
  EXPECT_EQ(rig.state.place, after.place);
}

TEST(PointerHandTest, ForceMovesTheHandAwayFromTheWillByItsStiffness) {
  Rig rig;
  rig.press();
  rig.live(1s);
  const double free = rig.state.position;
  rig.hand.apply(0.6);
  rig.live(2s);
  EXPECT_NEAR(rig.state.position - free, -0.6 / kMidGrip.stiffness, 0.1e-3);
}

TEST(PointerHandTest, NoFingerIsFasterOrReachesFartherThanAHand) {
  Rig rig;
  rig.press();
  rig.live(10ms);
  rig.finger.into = 1;
  const double start = rig.state.position;
  double fastest = 0;
  for (int i = 0; i < 2000; ++i) {
    rig.live(1ms);
    fastest = std::max(fastest, rig.state.velocity);
  }
  EXPECT_NEAR(rig.state.position - start, PointerHandConfig{}.reach, 0.1e-3);
  EXPECT_LT(fastest, 0.1);
}

TEST(PointerHandTest, NumbersThatAreNoneMoveNothing) {
  Rig rig;
  rig.press();
  rig.live(500ms);
  const HandState before = rig.state;
  rig.finger.into = std::numeric_limits<double>::quiet_NaN();
  rig.finger.x = std::numeric_limits<double>::infinity();
  rig.hand.apply(std::numeric_limits<double>::quiet_NaN());
  rig.live(500ms);
  EXPECT_NEAR(rig.state.position, before.position, 0.1e-3);
  EXPECT_EQ(rig.state.place, before.place);
}

RC_GTEST_PROP(PointerHandTest,
              AHandIsHeldOnlyByAFingerHeardOfInTime,
              (const std::vector<int>& steps)) {
  Rig rig;
  rig.reports = false;
  for (const int step : steps) {
    if (step % 5 == 0) rig.press();
    if (step % 5 == 1) rig.lift();
    if (step % 5 == 2 && rig.finger.held) rig.tell();
    rig.live(Duration{1ms} * (1 + std::abs(step) % 97));
    const bool heard = rig.finger.held && rig.now - rig.finger.arrived_at <= 150ms;
    RC_ASSERT(heard || !rig.state.pedal_held);
  }
}

TEST(PointerHandTest, ReadingItNeitherAllocatesNorWaits) {
  Rig rig;
  rig.press();
  test::RealtimeGuard guard;
  rig.live(300ms);
  rig.lift();
  rig.live(10ms);
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

}  // namespace
}  // namespace palp::surgeon
