#include "common/coupling/spline_estimator.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/core/filters.h"

/// Goal: a tissue that softens or has kinks is found where no smooth shape fits it, and one that
/// the smooth shapes fit is left to them.
/// Method: a tip that taps 4 mm deep, twice a second, seen through the transducer's pole.
namespace palp::coupling {
namespace {

constexpr double kNoise = 25e-6;  // [N^2], of an equation

/// x for x > 0 and 0 below, with a bend between.
double bend(double x) { return 0.2e-3 * std::log1p(std::exp(x / 0.2e-3)); }
double over(double depth, double where) { return bend(depth - where) - bend(-where); }

double skin(double depth) { return depth > 0 ? 300 * depth - 200 * over(depth, 1.8e-3) : 0; }
double kink(double depth) { return depth > 0 ? 80 * depth + 160 * over(depth, 2.5e-3) : 0; }
double layers(double depth) {
  return depth > 0 ? 200 * depth - 120 * over(depth, 1.5e-3) + 150 * over(depth, 3e-3) : 0;
}

SplineEstimator learn(double (*tissue)(double), const ContactModel& smooth) {
  constexpr double kPeriod = 1e-3;
  constexpr double kPole = 20;
  SplineEstimator spline;
  spline.begin(-2e-3, -3e-3);
  LowPass force{kPole, kPeriod};
  double sum = 0;
  for (int tick = 1; tick <= 4000; ++tick) {
    const double phase = 2 * std::numbers::pi * 2 * kPeriod * tick;
    const double position = -3e-3 + 3.5e-3 * (1 - std::cos(phase));
    if (tick % 5 == 1) spline.begin_equation();
    spline.follow(position, force.gain());
    sum += force.step(tissue(position));
    if (tick % 5 != 0) continue;
    spline.add({sum / 5}, 1, 0.9975);
    sum = 0;
  }
  spline.fit(smooth, {}, kNoise);
  return spline;
}

TEST(SplineEstimatorTest, FindsTissuesThatSoftenOrHaveKinks) {
  const ContactModel smooth{0, {0.15}, 6e-3};
  for (double (*tissue)(double) : {skin, kink, layers}) {
    const SplineEstimator spline = learn(tissue, smooth);
    EXPECT_EQ(spline.share(), 1);
    const ContactModel found{0, {}, 6e-3, spline.stiffness()};
    for (const double depth : {1e-3, 2e-3, 3e-3, 3.8e-3}) {
      EXPECT_NEAR(found.force(depth) / tissue(depth), 1, 0.02) << depth;
    }
    const auto rise = [](const auto& force) { return force(3.6e-3) - force(1.2e-3); };
    EXPECT_NEAR(rise([&](double d) { return found.force(d); }) / rise(tissue), 1, 0.02);
  }
}

TEST(SplineEstimatorTest, SaysNothingWhereTheSmoothShapesFit) {
  const ContactModel smooth{0, {0.02, 0.06, 0.01}, 6e-3};
  static const ContactModel kTissue = smooth;
  const SplineEstimator spline = learn([](double depth) { return kTissue.force(depth); }, smooth);
  EXPECT_EQ(spline.share(), 0);
}

TEST(SplineEstimatorTest, StartsWithWhatIsExpected) {
  SplineEstimator spline;
  KnotStiffness stiffness{};
  stiffness.fill(100);
  spline.begin(-2e-3, -3e-3);
  spline.expect(stiffness, 0.5);
  EXPECT_EQ(spline.share(), 0.5);
  EXPECT_EQ(spline.stiffness(), stiffness);
  spline.drop();
  EXPECT_EQ(spline.share(), 0);
}

}  // namespace
}  // namespace palp::coupling
