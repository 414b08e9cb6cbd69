#include "lab/run/pause_witness.h"

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

PauseWitness::Look pressing(double force, double force_true, double work = 0) {
  return {.guarded = true, .force = force, .force_true = force_true, .work = work};
}

TEST(PauseWitnessTest, WhatAHeldForceGaveIsNotTheLawsUntilItIsPaidBack) {
  PauseWitness witness;
  witness.look(pressing(1, 1, -0.4));
  PauseWitness::Look held = pressing(1, 1, -7);
  held.held = true;
  witness.look(held);
  witness.look(pressing(1, 1, -7.5));  // the last stretch of it
  EXPECT_EQ(witness.energy_given(), 0.4);
  witness.look(pressing(1, 1, -8));
  EXPECT_EQ(witness.energy_given(), 0.5) << "more than the held force gave";
  witness.look(pressing(1, 1, -1));
  witness.look(pressing(1, 1, -3));
  EXPECT_EQ(witness.energy_given(), 2) << "of what had been paid back";
}

TEST(PauseWitnessTest, AForceThatFollowsTheMotionIsNoKick) {
  PauseWitness witness;
  for (int i = 0; i < 20; ++i) witness.look(pressing(0.5, 0.5));
  PauseWitness::Look resumed = pressing(1.5, 1.5);
  resumed.resumed = true;
  witness.look(resumed);
  EXPECT_EQ(witness.kick(), 0);
  resumed = pressing(1.8, 1.5);
  witness.look(resumed);
  EXPECT_NEAR(witness.kick(), 0.3, 1e-12);
  witness.look(pressing(0.2, 1.5));
  EXPECT_NEAR(witness.drop(), 0.3, 1e-12) << "the smaller of both changes";
}

TEST(PauseWitnessTest, WithoutAPauseNothingIsJudged) {
  PauseWitness witness;
  for (int i = 0; i < 20; ++i) witness.look(pressing(i % 2, 0));
  EXPECT_EQ(witness.kick(), 0);
  EXPECT_EQ(witness.drop(), 0);
}

}  // namespace
}  // namespace palp::lab
