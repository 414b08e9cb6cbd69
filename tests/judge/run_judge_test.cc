#include "judge/run_judge.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

// What the metrics mean is tested in metrics_test.cc; here only what comes of judging as it goes.

RunTick tick_at(int ms, PhaseKind kind, int index) {
  RunTick tick;
  tick.at = 1e-3 * ms;
  tick.phase.kind = kind;
  tick.phase.index = index;
  tick.counted = true;
  tick.hand = 1e-3;
  return tick;
}

TEST(RunJudgeTest, AskedOnTheWayItCountsThePhaseThatIsNotOverAndGoesOn) {
  RunJudge judge{{}};
  judge.look(tick_at(0, PhaseKind::Tap, 1));
  judge.look(tick_at(1, PhaseKind::Tap, 2));
  EXPECT_EQ(judge.metrics().taps.size(), 2U);
  judge.look(tick_at(2, PhaseKind::Tap, 2));
  const RunMetrics metrics = judge.metrics();
  ASSERT_EQ(metrics.taps.size(), 2U);
  EXPECT_EQ(metrics.taps[1].began_at, 1e-3);
  EXPECT_EQ(metrics.taps[1].ended_at, 2e-3);
}

TEST(RunJudgeTest, TheFirstTapOfAPlaceIsThatOfTheFirstVisit) {
  RunJudge judge{{}};
  int ms = 0;
  // A tap of 200 N/m that is felt as `felt` [N/m].
  const auto tap = [&](Site site, double felt) {
    for (int i = 0; i < 400; ++i, ++ms) {
      RunTick tick = tick_at(ms, PhaseKind::Tap, 1);
      tick.phase.site = site;
      tick.phase.place = site == Site::A ? kSiteA : kSiteB;
      tick.hand = 1e-5 * i;
      tick.hand_velocity = 1e-2;
      tick.hand_force = felt * tick.hand;
      tick.force_true = 200 * tick.hand;
      judge.look(tick);
    }
  };
  tap(Site::B, 100);
  tap(Site::A, 150);
  tap(Site::B, 200);
  EXPECT_NEAR(judge.metrics().tap1_error[1], -0.5, 1e-6);
  EXPECT_NEAR(judge.metrics().tap1_error[0], -0.25, 1e-6);
}

TEST(RunJudgeTest, OfTwoFirstPressesTheOneThatFallsFartherBelowCounts) {
  for (const Site worse : {Site::A, Site::B}) {
    RunJudge judge{{}};
    int ms = 0;
    for (const Site site : {Site::A, Site::B}) {
      for (int i = 0; i < 3000; ++i, ++ms) {
        RunTick tick = tick_at(ms, PhaseKind::PressHold, 1);
        tick.phase.site = site;
        tick.force_true = 1;
        tick.hand_force = site == worse ? 0.6 : 0.8;
        judge.look(tick);
      }
    }
    EXPECT_NEAR(judge.metrics().contact.share_2s, 0.6, 1e-9);
  }
}

TEST(RunJudgeTest, WhatIsUnstableIsToldOfTheHandAndOfTheTip) {
  for (const bool hand : {false, true}) {
    RunJudge judge{{}};
    for (int ms = 0; ms < 1000; ++ms) {
      RunTick tick = tick_at(ms, PhaseKind::Tap, 1);
      const double swing = 1e-3 * std::sin(0.06 * ms);  // about 10 Hz
      tick.tip = 1e-3 + (hand ? 0 : swing);
      tick.hand = 1e-3 + (hand ? swing : 0);
      tick.energy_operator = -1e-7 * ms;
      judge.look(tick);
    }
    const RunMetrics metrics = judge.metrics();
    EXPECT_TRUE(metrics.unstable);
    EXPECT_EQ(metrics.contact.unstable_hand, hand);
    EXPECT_EQ(metrics.contact.unstable_tip, !hand);
  }
}

TEST(RunJudgeTest, EnergyIsCountedByContactAndFromAirToAir) {
  RunJudge judge{{}};
  double work = 0;
  for (int ms = 0; ms < 400; ++ms) {
    RunTick tick = tick_at(ms, PhaseKind::Tap, 1);
    const bool pressed = ms % 200 >= 100;
    tick.force_true = pressed ? 1 : 0;
    if (pressed) work -= 1e-5;
    tick.energy_operator = work;
    judge.look(tick);
  }
  RunTick away = tick_at(430, PhaseKind::Tap, 1);
  away.energy_operator = work;
  judge.look(away);
  EXPECT_NEAR(judge.metrics().contact.energy_contact, 1e-3, 1e-9);
  EXPECT_NEAR(judge.metrics().contact.energy_air_to_air, 2e-3, 1e-9);
}

TEST(RunJudgeTest, ATickOfNoPlaceCountsForNone) {
  RunJudge judge{{}};
  for (int ms = 0; ms < 200; ++ms) {
    RunTick tick = tick_at(ms, PhaseTag{}.kind, 0);
    tick.contact_force = tick.hand_force = tick.force_true = 1;
    tick.hand = 2e-3;
    judge.look(tick);
  }
  EXPECT_TRUE(std::isnan(judge.metrics().learning[0]));
  EXPECT_TRUE(std::isnan(judge.metrics().learning[1]));
}

TEST(RunJudgeTest, ABlackoutMayBeToldAsItBegins) {
  RunJudge judge{{}};
  RunTick tick = tick_at(0, PhaseKind::Other, 0);
  tick.tip_velocity = 5;
  judge.look(tick);
  EXPECT_TRUE(std::isnan(judge.metrics().stage_speed_max));
  judge.blackout(1e-3, 2e-3);
  EXPECT_EQ(judge.metrics().stage_speed_max, 0);
  tick = tick_at(1, PhaseKind::Other, 0);
  tick.tip_velocity = -2;
  judge.look(tick);
  EXPECT_EQ(judge.metrics().stage_speed_max, 2);
}

/// [J], at [s]: the work of a hand that the law feeds.
double fed(double t) { return -1e-4 * t; }

/// 2 s of one phase: hand and tip [m] over time [s]. The hand is fed.
RunMetrics judged(PhaseKind kind, double (*hand)(double), double (*tip)(double)) {
  RunJudge judge{{}};
  for (int i = 0; i < 2000; ++i) {
    RunTick tick = tick_at(i, kind, 1);
    tick.phase.elapsed = 1e-3 * i;
    tick.phase.duration = 2;
    tick.hand = hand(1e-3 * i);
    tick.tip = tip(1e-3 * i);
    tick.energy_operator = fed(1e-3 * i);
    judge.look(tick);
  }
  return judge.metrics();
}

double at_rest(double /*t*/) { return 2e-3; }
double hammering(double t) { return 2e-3 + 0.4e-3 * std::sin(85 * t); }         // 13.5 Hz
double slowly_hammering(double t) { return 2e-3 + 0.6e-3 * std::sin(13 * t); }  // 2 Hz
double creeping(double t) { return 2e-3 + 1.5e-3 * t; }

TEST(RunJudgeTest, ATipThatHammersUnderAQuietHandIsUnstable) {
  const RunMetrics metrics = judged(PhaseKind::PressHold, at_rest, hammering);
  EXPECT_TRUE(metrics.unstable);
  EXPECT_STREQ(metrics.unstable_reason, "the tip swings by itself");
  EXPECT_NEAR(metrics.contact.tip_swing, 0.8e-3, 0.02e-3);
}

/// Too slow for a limit cycle of the plant: the round trip is in this loop.
TEST(RunJudgeTest, ATipThatComesAndGoesUnderAHandThatHoldsIsUnstable) {
  const RunMetrics metrics = judged(PhaseKind::PressHold, at_rest, slowly_hammering);
  EXPECT_TRUE(metrics.unstable);
  EXPECT_STREQ(metrics.unstable_reason, "the tip swings by 1 mm or more under a hand that holds");
  EXPECT_FALSE(judged(PhaseKind::Tap, at_rest, slowly_hammering).unstable) << "a person's own will";
}

TEST(RunJudgeTest, ATipThatFollowsAHandIsJudgedByWhatItAdds) {
  const auto hand = [](double t) { return 2e-3 + 0.45e-3 * std::sin(13 * t); };
  const auto tip = [](double t) { return 2e-3 + 0.7e-3 * std::sin(13 * t); };
  EXPECT_FALSE(judged(PhaseKind::PressHold, hand, tip).unstable);
}

TEST(RunJudgeTest, AHandThatSwingsWhileItMovesIsUnstable) {
  const RunMetrics metrics = judged(PhaseKind::Other, hammering, at_rest);
  EXPECT_TRUE(metrics.unstable);
  EXPECT_STREQ(metrics.unstable_reason, "the hand swings by itself");
}

TEST(RunJudgeTest, AHandThatPaysForItsSwingsIsStable) {
  RunJudge judge{{}};
  for (int i = 0; i < 2000; ++i) {
    RunTick tick = tick_at(i, PhaseKind::Tap, 1);
    tick.hand = hammering(1e-3 * i);
    tick.energy_operator = -fed(1e-3 * i);
    judge.look(tick);
  }
  EXPECT_FALSE(judge.metrics().unstable);
}

TEST(RunJudgeTest, HandAndTipThatSwingNoMoreThanTheHandsOwnFingerAreStable) {
  for (const double own_swing : {0.4e-3, 0.2e-3}) {
    MetricsConfig config;
    config.own_swing = own_swing;
    RunJudge judge{config};
    for (int i = 0; i < 2000; ++i) {
      RunTick tick = tick_at(i, PhaseKind::Tap, 1);
      tick.hand = tick.tip = hammering(1e-3 * i);
      tick.energy_operator = fed(1e-3 * i);
      judge.look(tick);
    }
    const RunMetrics metrics = judge.metrics();
    EXPECT_NEAR(metrics.contact.hand_swing, 0.8e-3, 0.02e-3);
    EXPECT_NEAR(metrics.contact.tip_swing, 0.8e-3, 0.02e-3);
    EXPECT_EQ(metrics.contact.unstable_hand, own_swing < 0.3e-3);
    EXPECT_EQ(metrics.contact.unstable_tip, own_swing < 0.3e-3);
  }
}

TEST(RunJudgeTest, ASineThatAPersonMeansIsStable) {
  EXPECT_FALSE(judged(PhaseKind::FreeAir, hammering, hammering).unstable);
}

TEST(RunJudgeTest, AHandThatSinksAsItsTissueRelaxesIsStable) {
  EXPECT_FALSE(judged(PhaseKind::PressHold, creeping, creeping).unstable);
}

TEST(RunJudgeTest, NoTickNoVerdict) {
  const RunMetrics none = RunJudge{{}}.metrics();
  EXPECT_FALSE(none.unstable);
  EXPECT_TRUE(std::isnan(none.force_rms));
}

}  // namespace
}  // namespace palp::judge
