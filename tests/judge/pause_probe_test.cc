#include "judge/pause_probe.h"

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

PauseProbe::Look pressing(double force, double force_true, double work = 0) {
  return {.guarded = true, .force = force, .force_true = force_true, .work = work};
}

TEST(PauseProbeTest, WhatAHeldForceGaveIsNotTheLawsUntilItIsPaidBack) {
  PauseProbe probe;
  probe.look(pressing(1, 1, -0.4));
  PauseProbe::Look held = pressing(1, 1, -7);
  held.held = true;
  probe.look(held);
  probe.look(pressing(1, 1, -7.5));  // the last stretch of it
  EXPECT_EQ(probe.energy_given(), 0.4);
  probe.look(pressing(1, 1, -8));
  EXPECT_EQ(probe.energy_given(), 0.5) << "more than the held force gave";
  probe.look(pressing(1, 1, -1));
  probe.look(pressing(1, 1, -3));
  EXPECT_EQ(probe.energy_given(), 2) << "of what had been paid back";
}

TEST(PauseProbeTest, AForceThatFollowsTheMotionIsNoKick) {
  PauseProbe probe;
  for (int i = 0; i < 20; ++i) probe.look(pressing(0.5, 0.5));
  PauseProbe::Look resumed = pressing(1.5, 1.5);
  resumed.resumed = true;
  probe.look(resumed);
  EXPECT_EQ(probe.kick(), 0);
  resumed = pressing(1.8, 1.5);
  probe.look(resumed);
  EXPECT_NEAR(probe.kick(), 0.3, 1e-12);
  probe.look(pressing(0.2, 1.5));
  EXPECT_NEAR(probe.drop(), 0.3, 1e-12) << "the smaller of both changes";
}

/// What is left of a fall of 1 N while the hand goes `way` [m] in ten ticks, at one speed.
double left_of_a_fall(double way) {
  PauseProbe probe;
  PauseProbe::Look at = pressing(1.5, 0);
  for (int i = 0; i < 40; ++i, at.position += way / 10) probe.look(at);
  at.resumed = true;
  for (int i = 0; i < 10; ++i, at.position += way / 10, at.force -= 0.1) probe.look(at);
  probe.look(at);
  return probe.unexplained();
}

TEST(PauseProbeTest, AFallAlongTheHandsWayOutIsExplainedAsFarAsASpringWouldFall) {
  EXPECT_NEAR(left_of_a_fall(0), 1.0, 1e-12);
  EXPECT_NEAR(left_of_a_fall(0.2e-3), 1.0, 1e-12) << "a way in explains no fall";
  EXPECT_NEAR(left_of_a_fall(-0.2e-3), 1 - 3 * 0.2e-3 * 650, 1e-9) << "of 30 ticks";
}

TEST(PauseProbeTest, ADamperExplainsWhatAHandDoesThatTurns) {
  PauseProbe probe;
  for (int i = 0; i < 40; ++i) probe.look(pressing(1.5, 0));
  PauseProbe::Look turned = pressing(0.9, 0);
  turned.resumed = true;
  turned.position = -30e-6;  // 30 mm/s
  probe.look(turned);
  EXPECT_NEAR(probe.unexplained(), 0.6 - 650 * 30e-6 - 15 * 30e-3, 1e-9);
}

TEST(PauseProbeTest, WithoutAPauseNothingIsJudged) {
  PauseProbe probe;
  for (int i = 0; i < 20; ++i) probe.look(pressing(i % 2, 0));
  EXPECT_EQ(probe.kick(), 0);
  EXPECT_EQ(probe.drop(), 0);
}

}  // namespace
}  // namespace palp::judge
