#include "patient_site/estimator/bayes_estimator.h"

#include <gtest/gtest.h>

#include "patient_site/estimator/depth_estimator.h"
#include "tests/patient_site/tapping.h"

namespace palp::patient {
namespace {

/// Taps beside, then over the inclusion, as `tap` of tapping.h gives them.
std::vector<DepthEstimate> palpate(const char* spec, const SimulatedPhantomConfig& sensor) {
  const auto phantom = make_phantom(spec);
  EXPECT_TRUE(phantom);
  estimator::DepthEstimatorConfig config;
  config.bayes.prior.radius_min = config.bayes.prior.radius_max = 8e-3;
  config.bayes.prior.ratio_min = config.bayes.prior.ratio_max = 200;
  estimator::DepthEstimator estimator{config};
  std::vector<DepthEstimate> out;
  TimePoint now{};
  for (const double lateral : {0.0, 20e-3}) {
    SimulatedPhantomConfig place = sensor;
    place.start_position = -3e-3;
    place.start_lateral = lateral;
    place.seed = sensor.seed + static_cast<std::uint64_t>(lateral * 1e3);
    SimulatedPhantom site{*phantom, place};
    LowPass co_filter{20, 1e-3};
    co_filter.reset(-3e-3);
    for (int i = 0; i < 4 * 1200; ++i) {
      now += std::chrono::milliseconds{1};
      const StageState stage = site.read(now);
      const auto force = site.sample(now);
      const auto estimate = estimator.add({.at = now,
                                           .position = co_filter.step(stage.position),
                                           .force = force->force,
                                           .lateral = lateral});
      if (estimate && lateral > 0) out.push_back(*estimate);
      const double t = std::min(i % 1200 * 1e-3, 1.0);
      site.move_to({-3e-3 + 3.4e-3 * (1 - std::cos(2 * std::numbers::pi * t)), lateral});
    }
  }
  return out;
}

TEST(BayesEstimatorTest, FindsTheDepthAndSaysHowSureItIs) {
  const auto estimates = palpate("ball depth=9 radius=8 ratio=200", {});
  ASSERT_EQ(estimates.size(), 4U);
  const DepthEstimate& last = estimates.back();
  EXPECT_EQ(last.verdict, DepthVerdict::Found);
  EXPECT_NEAR(last.depth, 9e-3, 4 * last.depth_stddev);
  EXPECT_LT(last.depth_stddev, 1e-3);
  EXPECT_LT(last.depth_low, last.depth);
  EXPECT_GT(last.depth_high, last.depth);
}

TEST(BayesEstimatorTest, EveryTapMakesItSurer) {
  const auto estimates = palpate("ball depth=9 radius=8 ratio=200", {});
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_LT(estimates.back().depth_stddev, estimates.front().depth_stddev);
}

/// A tap of 4 mm; hesitant: it goes back by more than 1 mm near its end, and on again.
double tap_position(double t, bool hesitant) {
  const double smooth = -3e-3 + 3.4e-3 * (1 - std::cos(2 * std::numbers::pi * t));
  if (!hesitant || t < 0.36 || t > 0.56) return smooth;
  return smooth - 1.25e-3 * (1 - std::cos(2 * std::numbers::pi * (t - 0.36) / 0.2));
}

/// The last estimate after `before` taps, hesitant ones, and a smooth one, all over the inclusion.
DepthEstimate after_hesitant(int before, int* refused) {
  const auto phantom = make_phantom("ball depth=9 radius=8 ratio=200");
  EXPECT_TRUE(phantom);
  estimator::DepthEstimatorConfig config;
  config.bayes.prior.radius_min = config.bayes.prior.radius_max = 8e-3;
  config.bayes.prior.ratio_min = config.bayes.prior.ratio_max = 200;
  config.bayes.stiffness.scale_stddev = 2e-3;
  estimator::DepthEstimator estimator{config};
  SimulatedPhantomConfig place;
  place.start_position = -3e-3;
  place.start_lateral = 20e-3;
  SimulatedPhantom site{*phantom, place};
  LowPass co_filter{20, 1e-3};
  co_filter.reset(-3e-3);
  DepthEstimate last;
  TimePoint now{};
  for (int i = 0; i < (before + 1) * 1200; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    const auto force = site.sample(now);
    const auto estimate = estimator.add({.at = now,
                                         .position = co_filter.step(stage.position),
                                         .force = force->force,
                                         .lateral = 20e-3});
    if (estimate && estimate->reason == DepthReason::StrokeNotMonotone) ++*refused;
    if (estimate) last = *estimate;
    const double t = std::min(i % 1200 * 1e-3, 1.0);
    site.move_to({tap_position(t, i / 1200 < before), 20e-3});
  }
  return last;
}

TEST(BayesEstimatorTest, AStrokeThatIsNotMonotoneCountsForTheNext) {
  int refused = 0;
  const DepthEstimate alone = after_hesitant(0, &refused);
  ASSERT_EQ(refused, 0);
  const DepthEstimate last = after_hesitant(3, &refused);
  EXPECT_EQ(refused, 3);
  ASSERT_EQ(last.verdict, DepthVerdict::Found);
  EXPECT_NEAR(last.depth, 9e-3, 4 * last.depth_stddev);
  // Four strokes know twice as well as one, were they alike and nothing known beforehand.
  EXPECT_LT(last.depth_stddev, 0.65 * alone.depth_stddev);
}

TEST(BayesEstimatorTest, WithoutInclusionItSaysWhatIsExcluded) {
  const auto estimates = palpate("none", {});
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_EQ(estimates.back().verdict, DepthVerdict::None);
  EXPECT_GT(estimates.back().depth_low, 5e-3);
}

TEST(BayesEstimatorTest, WithoutNoiseItGivesBackThePhantom) {
  SimulatedPhantomConfig sensor;
  sensor.force_noise = 1e-4;
  sensor.force_quantum = 0;
  const auto estimates = palpate("ball depth=12.3 radius=8 ratio=200", sensor);
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_NEAR(estimates.back().depth, 12.3e-3, 0.15e-3);
}

TEST(BayesEstimatorTest, AnotherPhantomThanItsWordsIsRefused) {
  for (const char* spec : {"ball depth=1 radius=8 ratio=200",
                           "ball depth=12 radius=8 ratio=2000",
                           "ball depth=12 size=8",
                           "ball depth=x",
                           "ball ",
                           "ball depth=27 radius=16 ratio=10"}) {
    EXPECT_FALSE(make_phantom(spec)) << spec;
  }
  EXPECT_TRUE(make_phantom("cylinder depth=12 radius=8 ratio=200"));
}

}  // namespace
}  // namespace palp::patient
