#include "judge/metrics.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

// Goal: the metrics are what their definitions say. Method: hand-made ticks in which the hand is
// shown exactly `gain` times the true force, so every stiffness error must come out as gain - 1.

namespace palp::judge {
namespace {

double tissue(Site site, double depth) {
  const double stiffness = site == Site::A ? 150 : 300;  // [N/m]
  return stiffness * std::max(0.0, depth);
}

struct Builder {
  std::vector<RunTick> ticks;
  double gain_a{1};
  double gain_b{1};

  void phase(PhaseKind kind,
             Site site,
             int index,
             double duration,
             const std::function<double(double)>& hand) {
    const int count = static_cast<int>(duration * 1000);
    for (int k = 0; k < count; ++k) {
      const double t = k * 1e-3;
      RunTick tick;
      tick.phase = {kind, site, site == Site::A ? kSiteA : kSiteB, index, t, duration};
      tick.counted = true;
      tick.hand = hand(t);
      tick.hand_velocity = (hand(t + 1e-3) - hand(t)) / 1e-3;
      tick.force_true = tissue(site, tick.hand);
      tick.hand_force = (site == Site::A ? gain_a : gain_b) * tick.force_true;
      tick.tip = tick.hand;
      ticks.push_back(tick);
    }
  }
  void palpation() {
    phase(PhaseKind::FreeAir, Site::A, 0, 4, [](double t) { return -0.01 + 0.001 * t; });
    for (const Site site : {Site::A, Site::B}) {
      for (int tap = 1; tap <= 4; ++tap) {
        phase(PhaseKind::Tap, site, tap, 1, [](double t) {
          return -0.003 + 0.007 * 0.5 * (1 - std::cos(6.283185307 * t));
        });
      }
      phase(PhaseKind::PressHold, site, 1, 2, [](double) { return 0.002; });
      phase(PhaseKind::PressHold, site, 2, 2, [](double) { return 0.004; });
      phase(PhaseKind::LiftHold, site, 0, 2, [](double) { return -0.01; });
    }
  }
};

TEST(MetricsTest, ExactRenderingHasNoError) {
  Builder builder;
  builder.palpation();
  const RunMetrics metrics = metrics_of(builder.ticks, {});
  EXPECT_FALSE(metrics.unstable);
  for (int site = 0; site < 2; ++site) {
    EXPECT_NEAR(metrics.tap_error[site], 0, 1e-12);
    EXPECT_NEAR(metrics.tap1_error[site], 0, 1e-12);
    EXPECT_NEAR(metrics.static_error[site], 0, 1e-12);
  }
  EXPECT_NEAR(metrics.ratio_error, 0, 1e-12);
  EXPECT_NEAR(metrics.drift, 0, 1e-12);
  ASSERT_EQ(metrics.taps.size(), 8U);
  EXPECT_NEAR(metrics.taps[0].stiffness.truth().value(), 150, 1e-9);
  EXPECT_NEAR(metrics.taps[7].stiffness.felt().value(), 300, 1e-9);
  EXPECT_NEAR(metrics.taps[7].hand_max, 0.004, 1e-5);
}

TEST(MetricsTest, AGainOfTheRenderedForceIsTheStiffnessError) {
  Builder builder;
  builder.gain_a = 0.7;
  builder.gain_b = 1.2;
  builder.palpation();
  const RunMetrics metrics = metrics_of(builder.ticks, {});
  EXPECT_NEAR(metrics.tap_error[0], -0.3, 1e-12);
  EXPECT_NEAR(metrics.tap_error[1], 0.2, 1e-12);
  EXPECT_NEAR(metrics.static_error[0], -0.3, 1e-12);
  EXPECT_NEAR(metrics.static_error[1], 0.2, 1e-12);
  EXPECT_NEAR(metrics.ratio_error, 1.2 / 0.7 - 1, 1e-12);
  EXPECT_NEAR(metrics.static_ratio_error, 1.2 / 0.7 - 1, 1e-12);
}

TEST(MetricsTest, ASwingOfOneMillimetreInTheSecondHalfOfAHoldIsUnstable) {
  for (const double swing : {0.00098, 0.00102}) {
    Builder builder;
    builder.palpation();
    for (RunTick& tick : builder.ticks) {
      const bool late = tick.phase.elapsed > 0.5 * tick.phase.duration;
      if (tick.phase.kind == PhaseKind::LiftHold && late) {
        tick.hand += 0.5 * swing * (static_cast<int>(tick.phase.elapsed * 1000) % 2 != 0 ? 1 : -1);
      }
    }
    EXPECT_EQ(metrics_of(builder.ticks, {}).unstable, swing > 0.001) << swing;
  }
}

TEST(MetricsTest, TwoTenthsOfASecondAtTheForceCapIsUnstable) {
  for (const int ticks : {199, 201}) {
    Builder builder;
    builder.palpation();
    for (int k = 0; k < ticks; ++k)
      builder.ticks[static_cast<std::size_t>(10 * k)].hand_force = -8.5;
    EXPECT_EQ(metrics_of(builder.ticks, {}).unstable, ticks > 200) << ticks;
  }
}

TEST(MetricsTest, NotANumberIsUnstable) {
  Builder builder;
  builder.palpation();
  builder.ticks[100].hand = NAN;
  EXPECT_TRUE(metrics_of(builder.ticks, {}).unstable);
}

TEST(MetricsTest, TicksOutsideEngagedAndHoldDoNotCount) {
  Builder builder;
  builder.palpation();
  for (RunTick& tick : builder.ticks) {
    if (tick.phase.kind == PhaseKind::Tap && tick.phase.index == 3) {
      tick.counted = false;
      tick.hand_force = 1e3;
    }
  }
  EXPECT_NEAR(metrics_of(builder.ticks, {}).tap_error[0], 0, 1e-12);
}

TEST(MetricsTest, FewerThanTwentyOneTicksGiveNoStiffness) {
  Builder builder;
  builder.phase(PhaseKind::Tap, Site::A, 2, 0.02, [](double t) {
    return 0.0015 + 0.1 * t;
  });  // 20 ticks, all in the window
  EXPECT_TRUE(std::isnan(metrics_of(builder.ticks, {}).tap_error[0]));
  builder.phase(PhaseKind::Tap, Site::A, 3, 0.001, [](double) { return 0.0035; });
  builder.ticks.back().hand_velocity = 1;
  EXPECT_FALSE(std::isnan(metrics_of(builder.ticks, {}).tap_error[0]));
}

TEST(MetricsTest, ForceStepIsOverTenMilliseconds) {
  Builder builder;
  builder.phase(PhaseKind::Other, Site::A, 0, 1, [](double) { return -0.01; });
  for (std::size_t k = 0; k < builder.ticks.size(); ++k) {
    builder.ticks[k].hand_force = 0.01 * static_cast<double>(k);
  }
  EXPECT_NEAR(metrics_of(builder.ticks, {}).force_step_10ms, 0.1, 1e-12);
}

TEST(MetricsTest, AStepOfAnEventIsNeitherTheHandsMotionNorWhatWasNotFelt) {
  Builder builder;
  builder.phase(PhaseKind::Other, Site::A, 0, 1, [](double t) { return 0.01 * t; });
  const double swept = metrics_of(builder.ticks, {}).force_step_10ms;
  ASSERT_GT(swept, 0);
  EXPECT_EQ(metrics_of(builder.ticks, {}).force_step_event, 0) << "exact rendering";
  Builder blind = builder;
  for (RunTick& tick : blind.ticks) tick.hand_force = 0;
  EXPECT_EQ(metrics_of(blind.ticks, {}).force_step_event, 0) << "nothing was felt, nothing changed";
  for (std::size_t k = 500; k < 1000; ++k) builder.ticks[k].hand_force += 0.3;
  EXPECT_NEAR(metrics_of(builder.ticks, {}).force_step_event, 0.3, 1e-12);
}

}  // namespace
}  // namespace palp::judge
