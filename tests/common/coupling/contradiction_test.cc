#include "common/coupling/contradiction.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "common/coupling/mmt.h"
#include "tests/common/coupling/hand_loop.h"
#include "tests/common/coupling/told_hand.h"

namespace palp::coupling {
namespace {

constexpr double kPlay = 0.03;  // [N]

TEST(ContradictionTest, WhoLearnsTakesNothingBack) {
  Contradiction contradiction{kPlay};
  for (int news = 0; news < 1000; ++news) {
    contradiction.tell(2e-3 + (news % 2 == 0 ? 0.02 : -0.02));  // 2 N in all, and noise
    contradiction.age(1e-3);
  }
  EXPECT_EQ(contradiction.taken_back(), 0);
}

TEST(ContradictionTest, WhatIsRaisedAndLoweredAgainIsTakenBack) {
  for (const double first : {0.5, -0.5}) {
    Contradiction contradiction{kPlay};
    contradiction.tell(first);
    EXPECT_EQ(contradiction.taken_back(), 0);
    contradiction.tell(-first);
    EXPECT_NEAR(contradiction.taken_back(), 0.44, 1e-9) << "less the play, to either side";
    contradiction.tell(first);
    contradiction.tell(-first);
    EXPECT_NEAR(contradiction.taken_back(), 0.88, 1e-9);
  }
}

TEST(ContradictionTest, IsForgottenWithinSomeSeconds) {
  Contradiction contradiction{kPlay};
  contradiction.tell(0.5);
  contradiction.tell(-0.5);
  const double at_first = contradiction.taken_back();
  for (int tick = 0; tick < 30'000; ++tick) contradiction.age(1e-3);
  EXPECT_NEAR(contradiction.taken_back() / at_first, 0.05, 0.001);
}

TEST(ContradictionTest, TheMoreIsTakenBackTheSlowerItsPeerIsFollowed) {
  Contradiction contradiction{kPlay};
  EXPECT_EQ(contradiction.slower(0.2, 0.1), 1);
  double before = 1;
  for (int lie = 0; lie < 5; ++lie) {
    contradiction.tell(0.3);
    contradiction.tell(-0.3);
    const double slower = contradiction.slower(0.2, 0.1);
    EXPECT_NEAR(slower, 1 + std::pow((0.24 * (lie + 1) - 0.2) / 0.1, 2), 1e-9);
    EXPECT_GT(slower, before);
    before = slower;
  }
}

/// What a patient site tells after a time [s].
using Story = std::function<ModelPayload(double)>;

/// How far a light hand that holds in the tissue is moved to and fro in the last two of eight
/// seconds [m].
double moved(const Story& story, const MmtConfig& config) {
  hand_loop::Hand hand{.stiffness = 100};
  MmtSurgeon law{config};
  law.begin_epoch(hand.position);
  double force = 0;
  double least = 1;
  double most = -1;
  for (std::uint64_t tick = 0; tick < 8000; ++tick) {
    const double at = 1e-3 * static_cast<double>(tick);
    hand.live(std::min(4e-3, -3e-3 + 10e-3 * at), force);
    force = told_hand(law, story(at), hand.position, force);
    if (tick < 6000) continue;
    least = std::min(least, hand.position);
    most = std::max(most, hand.position);
  }
  return most - least;
}

ModelPayload soft_or_stiff(double at) {
  return {.version = 1, .c = {0, std::fmod(at, 0.4) < 0.2 ? 0.05 : 0.3}, .depth_max = 5e-3};
}

ModelPayload another_breath(double at) {
  return {.version = 1,
          .c = {0, 0.15},
          .depth_max = 5e-3,
          .swing = std::fmod(at, 0.4) < 0.2 ? 2e-3 : -2e-3,
          .swing_quadrature = std::fmod(at, 0.4) < 0.2 ? 2e-3 : -2e-3,
          .swing_rate = 6};
}

TEST(MmtSurgeonTest, APeerThatTakesBackWhatItToldMovesNoHand) {
  MmtConfig all_believed;
  all_believed.believed = all_believed.surface_believed = 1e9;
  for (const Story& story : {Story{soft_or_stiff}, Story{another_breath}}) {
    const double unguarded = moved(story, all_believed);
    EXPECT_GT(unguarded, 0.5e-3) << "there is something to hold back";
    EXPECT_LT(moved(story, {}), 0.25 * unguarded);
  }
}

TEST(MmtSurgeonTest, APeerThatWasDoubtedIsFollowedWhereItStaysWithWhatItTells) {
  MmtSurgeon law{{}};
  constexpr double kDepth = 2e-3;  // [m]
  law.begin_epoch(kDepth);
  double force = 0;
  for (int tick = 0; tick < 20'000; ++tick) {
    const double at = 1e-3 * tick;
    force = told_hand(law, soft_or_stiff(at < 10 ? at : 0), kDepth, force);
  }
  const double told = contact_model(soft_or_stiff(0)).force(kDepth);
  EXPECT_NEAR(force / told, 1, 0.1) << "after 10 s";
}

/// Of a doubted peer the model goes slowly, but it goes: its surface, which is none any more, does
/// not come up under the hand first.
TEST(MmtSurgeonTest, OfNoTissueNothingComesUpUnderTheHand) {
  MmtSurgeon law{{}};
  law.begin_epoch(2e-3);
  double force = 0;
  double at_last = 0;
  for (int tick = 0; tick < 12'000; ++tick) {
    const double at = 1e-3 * tick;
    force = told_hand(law,
                      at < 8 ? soft_or_stiff(at) : ModelPayload{.version = 1, .surface = -15e-3},
                      2e-3,
                      force);
    if (at > 8) {
      ASSERT_LE(force, at_last + 1e-9) << at;
    }
    at_last = force;
  }
  EXPECT_GT(force, 0) << "there is something that could come up";
}

TEST(MmtSurgeonTest, APeerThatLearnsIsFollowedAtOnce) {
  MmtConfig all_believed;
  all_believed.believed = all_believed.surface_believed = 1e9;
  // Of ever more, as a tissue is found: half of it comes after 6.5 s.
  const auto learned = [](double at) {
    return ModelPayload{.version = 1, .c = {0, at < 6.5 ? 0.1 : 0.2}, .depth_max = 5e-3};
  };
  EXPECT_GT(moved(learned, {}), 0.2e-3);
  EXPECT_EQ(moved(learned, {}), moved(learned, all_believed));
}

/// A light hand is deep in a tissue that was just met, and what is told of there is a guess.
TEST(MmtSurgeonTest, APeerThatGuessesOfWhatIsNotFeltYetIsFollowedAllTheSame) {
  constexpr double kDepth = 6e-3;  // [m]
  MmtSurgeon law{{}};
  law.begin_epoch(kDepth);
  double force = 0;
  const auto told = [](double soft, double stiff) {
    return ModelPayload{.version = 1, .c = {soft, 0, 0, 0, stiff}, .depth_max = 5e-3};
  };
  // As far as it is felt, all these tissues are one.
  for (int tick = 0; tick < 300; ++tick) {
    force = told_hand(law, told(0.3, tick % 10 < 5 ? 1e-4 : 2e-4), kDepth, force);
  }
  const double felt = force;
  EXPECT_GT(felt, 0.1);
  EXPECT_LT(felt, 0.3);
  for (int tick = 0; tick < 300; ++tick) force = told_hand(law, told(0.001, 0), kDepth, force);
  EXPECT_LT(force, 0.2 * felt);
}

}  // namespace
}  // namespace palp::coupling
