#include "judge/truth_judge.h"

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

PlantTruth tick_of(int ms) {
  PlantTruth truth;
  truth.run_time = std::chrono::milliseconds{ms};
  truth.performing = truth.counted = truth.guarded = true;
  return truth;
}

TEST(TruthJudgeTest, OnlyTicksOfTheScriptAreJudgedButEnergyIsOfTheWholeRun) {
  TruthJudge judge{{}};
  PlantTruth before = tick_of(0);
  before.performing = false;
  before.hand_work = -2e-3;
  EXPECT_FALSE(judge.look(before));
  const auto tick = judge.look(tick_of(1));
  ASSERT_TRUE(tick);
  EXPECT_EQ(tick->at, 1e-3);
  EXPECT_EQ(tick->energy_operator_min, -2e-3);
  EXPECT_EQ(judge.metrics().energy_operator, 2e-3);
}

TEST(TruthJudgeTest, AStepCountsWhileTheForceIsTheSitesOwn) {
  TruthJudge judge{{}};
  for (int ms = 0; ms < 20; ++ms) {
    PlantTruth truth = tick_of(ms);
    truth.guarded = ms < 5;
    truth.hand_force = ms < 4 ? 0 : ms < 5 ? 0.5 : 3;
    judge.look(truth);
  }
  EXPECT_EQ(judge.metrics().whole.force_step, 0.5);
}

TEST(TruthJudgeTest, ADarkPathIsJudgedForTwoSecondsMore) {
  const auto speed = [](int ms) {
    TruthJudge judge{{}};
    PlantTruth dark = tick_of(1000);
    dark.dark = true;
    judge.look(dark);
    PlantTruth later = tick_of(ms);
    later.tip_velocity = 0.3;
    judge.look(later);
    return judge.metrics().stage_speed_max;
  };
  EXPECT_EQ(speed(4999), 0.3);
  EXPECT_EQ(speed(5001), 0);
}

TEST(TruthJudgeTest, APhaseOfAnUnknownKindIsNone) {
  TruthJudge judge{{}};
  PlantTruth truth = tick_of(0);
  truth.phase_kind = 99;
  truth.phase_place = kSiteB;
  const auto tick = judge.look(truth);
  ASSERT_TRUE(tick);
  EXPECT_EQ(tick->phase.kind, PhaseKind::Other);
  EXPECT_EQ(tick->phase.site, Site::B);
}

}  // namespace
}  // namespace palp::judge
