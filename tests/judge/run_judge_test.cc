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

TEST(RunJudgeTest, NoTickNoVerdict) {
  const RunMetrics none = RunJudge{{}}.metrics();
  EXPECT_FALSE(none.unstable);
  EXPECT_TRUE(std::isnan(none.force_rms));
}

}  // namespace
}  // namespace palp::judge
