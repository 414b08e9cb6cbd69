#include "patient_site/plane_motion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace palp::patient {
namespace {

using record::NoteCode;
constexpr double kTick = 1e-3;  // [s]

PlaneMotion at(const Place& place, const PlaneMotionConfig& config = {}) {
  PlaneMotion motion{config};
  motion.begin(place);
  return motion;
}

TEST(PlaneMotionTest, NeverExceedsTravelSpeedAndAccelerationOfAnyAxisWhateverIsAsked) {
  rc::check([] {
    PlaneMotion motion = at(kSiteA);
    Place before = kSiteA;
    Place speed_before;
    for (int i = 0; i < 80; ++i) {
      const Place asked{*rc::gen::inRange(-600, 600) * 1e-3, *rc::gen::inRange(-600, 600) * 1e-3};
      const bool in_contact = *rc::gen::inRange(0, 4) == 0;
      (void)motion.follow(asked, in_contact, kTick);
      const Place now = motion.command();
      const Place speed{(now.x - before.x) / kTick, (now.y - before.y) / kTick};
      const double fastest = in_contact ? 0.02 : 0.15;
      RC_ASSERT(std::abs(speed.x) <= fastest + 1e-9);
      RC_ASSERT(std::abs(speed.y) <= fastest + 1e-9);
      if (!in_contact) {
        RC_ASSERT(std::abs(speed.x - speed_before.x) <= 8e-3 + 1e-9);
        RC_ASSERT(std::abs(speed.y - speed_before.y) <= 8e-3 + 1e-9);
      }
      RC_ASSERT(std::abs(now.x) <= 0.25 && std::abs(now.y) <= 0.25);
      before = now;
      speed_before = speed;
    }
  });
}

TEST(PlaneMotionTest, ADragKeepsToItsLineAndToItsSpeedInAnyDirection) {
  rc::check([] {
    PlaneMotion motion = at(kSiteA);
    const Place aim{*rc::gen::inRange(-60, 60) * 1e-3, *rc::gen::inRange(1, 60) * 1e-3};
    Place before = kSiteA;
    for (int i = 0; i < 300; ++i) {
      (void)motion.follow(aim, true, kTick);
      const Place now = motion.command();
      RC_ASSERT(distance(now, before) <= 0.02 * kTick + 1e-12);
      RC_ASSERT(std::abs(now.x * aim.y - now.y * aim.x) / std::hypot(aim.x, aim.y) < 0.3e-3);
      before = now;
    }
  });
}

TEST(PlaneMotionTest, ArrivesExactlyAndDoesNotRunPast) {
  PlaneMotion motion = at({-7e-3, 2e-3});
  const Place aim{20e-3, -1.3e-3};
  for (int i = 0; i < 400; ++i) {
    EXPECT_EQ(motion.follow(aim, false, kTick), NoteCode::None);
    ASSERT_LE(motion.command().x, aim.x + 0.2e-3) << "the braking is that of steps";
  }
  EXPECT_EQ(motion.command(), aim);
}

TEST(PlaneMotionTest, SaysWhereItsTravelEnds) {
  PlaneMotion motion = at(kSiteA, {.travel_x = 0.02, .travel_y = 0.5});
  EXPECT_EQ(motion.follow({10e-3, 0}, false, kTick), NoteCode::None);
  for (int i = 0; i < 500; ++i) {
    EXPECT_EQ(motion.follow({10.1e-3, 0}, false, kTick), NoteCode::PlaceBeyondTravel);
  }
  EXPECT_EQ(motion.command(), (Place{10e-3, 0}));
  for (int i = 0; i < 3000; ++i) {
    EXPECT_EQ(motion.follow({0, -0.26}, false, kTick), NoteCode::PlaceBeyondTravel);
  }
  EXPECT_EQ(motion.command(), (Place{0, -0.25}));
}

TEST(PlaneMotionTest, WhatCannotDragStaysWhilePressedAndForgivesATremblingHand) {
  PlaneMotion motion = at(kSiteA, {.drag_speed = 0});
  EXPECT_EQ(motion.follow({1e-3, 0}, true, kTick), NoteCode::None);
  EXPECT_EQ(motion.follow({0.8e-3, 0.8e-3}, true, kTick), NoteCode::DragRefused);
  EXPECT_EQ(motion.command(), kSiteA);
  EXPECT_EQ(motion.follow({0.8e-3, 0.8e-3}, false, kTick), NoteCode::None);
  EXPECT_NE(motion.command(), kSiteA);
}

TEST(PlaneMotionTest, WhatIsNoNumberIsNotFollowed) {
  PlaneMotion motion = at({3e-3, 3e-3});
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(motion.follow({bad, 0}, false, kTick), NoteCode::NotFinite);
    EXPECT_EQ(motion.follow({0, bad}, false, kTick), NoteCode::NotFinite);
  }
  EXPECT_EQ(motion.command(), (Place{3e-3, 3e-3}));
}

}  // namespace
}  // namespace palp::patient
