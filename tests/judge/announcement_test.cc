#include "judge/announcement.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

/// A contact of `lasts` [s] with 1 N, `felt` [N] of it, told of from `told_from` [s] on.
void press(Announcement& announcement, double began, double lasts, double felt, double told_from) {
  for (int i = 0; i < 1000 * lasts; ++i) {
    const double since = 1e-3 * i;
    announcement.look({.at = began + since, .felt = felt, .truth = 1, .told = since >= told_from});
  }
  announcement.look({.at = began + lasts});
}

double share_of(double lasts, double felt, double told_from, double round_trip = 0.1) {
  Announcement announcement{round_trip};
  press(announcement, 1, lasts, felt, told_from);
  return announcement.share();
}

TEST(AnnouncementTest, IsInTimeUpToHalfASecondAfterTheForceBecameShort) {
  EXPECT_EQ(share_of(2, 0.5, 0.55), 1);
  EXPECT_EQ(share_of(2, 0.5, 0.65), 0);
  EXPECT_EQ(share_of(2, 0.5, 0.0), 1) << "still told from before";
}

TEST(AnnouncementTest, AForceThatIsNearlyWholeOrSoonWholeNeedsNone) {
  EXPECT_TRUE(std::isnan(share_of(2, 0.96, 9)));
  EXPECT_EQ(share_of(2, 0.94, 9), 0);
  EXPECT_TRUE(std::isnan(share_of(0.55, 0.5, 9))) << "let go of before";
  EXPECT_TRUE(std::isnan(share_of(0.9, 0.5, 9, 0.5))) << "no news can be there yet";
}

TEST(AnnouncementTest, AHandThatMovesIsNotHeld) {
  Announcement announcement{0};
  for (int i = 0; i < 2000; ++i) {
    announcement.look({.at = 1e-3 * i, .truth = 1, .velocity = 6e-3});
  }
  EXPECT_TRUE(std::isnan(announcement.share()));
}

TEST(AnnouncementTest, WhatIsToldOfAWholeForceIsInVain) {
  Announcement announcement{0.5};
  EXPECT_TRUE(std::isnan(announcement.in_vain())) << "the hand never rested";
  press(announcement, 1, 2.5, 1, 1.5);
  EXPECT_NEAR(announcement.in_vain(), 0.5, 1e-3) << "from a round trip after contact on";
  press(announcement, 5, 2.5, 0.5, 0);
  EXPECT_NEAR(announcement.in_vain(), 0.25, 1e-3) << "the other was short";
}

TEST(AnnouncementTest, EachShortageCounts) {
  Announcement announcement{0.1};
  press(announcement, 1, 2, 0.5, 0.3);
  press(announcement, 5, 2, 0.5, 9);
  EXPECT_EQ(announcement.share(), 0.5);
}

}  // namespace
}  // namespace palp::judge
