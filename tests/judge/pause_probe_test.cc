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

TEST(PauseProbeTest, AFallAlongTheHandsWayOutIsExplainedAsFarAsASpringWouldFall) {
  for (const double way : {0.0, 1e-3, -1e-3}) {  // [m]
    PauseProbe probe;
    for (int i = 0; i < 40; ++i) probe.look(pressing(1.5, 0));
    PauseProbe::Look resumed = pressing(1.5, 0);
    resumed.resumed = true;
    probe.look(resumed);
    PauseProbe::Look later = pressing(0.5, 0);
    later.position = way;
    probe.look(later);
    EXPECT_NEAR(probe.unexplained(), way < 0 ? 0.35 : 1.0, 1e-12);
  }
}

TEST(PauseProbeTest, WithoutAPauseNothingIsJudged) {
  PauseProbe probe;
  for (int i = 0; i < 20; ++i) probe.look(pressing(i % 2, 0));
  EXPECT_EQ(probe.kick(), 0);
  EXPECT_EQ(probe.drop(), 0);
}

}  // namespace
}  // namespace palp::judge
