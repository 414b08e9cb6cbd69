#include "depth/bayes_estimator.h"

#include <gtest/gtest.h>

#include "depth/depth_estimator.h"
#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

/// That knows size and stiffness of the inclusion.
depth::DepthEstimatorConfig knowing() {
  depth::DepthEstimatorConfig config;
  config.bayes.prior.radius_min = config.bayes.prior.radius_max = 8e-3;
  config.bayes.prior.ratio_min = config.bayes.prior.ratio_max = 200;
  return config;
}

constexpr Tapping kTaps{.taps = 4, .indentation = 3.8e-3, .rest_time = 0.2};

/// What is said over the inclusion, after taps beside it.
std::vector<DepthEstimate> estimates_over(const char* spec, const SimulatedPhantomConfig& sensor) {
  const auto phantom = plain_at_a(spec);
  EXPECT_TRUE(phantom);
  depth::DepthEstimator estimator{knowing()};
  std::vector<DepthEstimate> out;
  palpate(*phantom, sensor, kTaps, [&](const ContactSample& sample) {
    const auto estimate = estimator.add(sample);
    if (estimate && sample.place == kSiteB) out.push_back(*estimate);
  });
  return out;
}

TEST(BayesEstimatorTest, FindsTheDepthAndSaysHowSureItIs) {
  const auto estimates = estimates_over("ball depth=9 radius=8 ratio=200", {});
  ASSERT_EQ(estimates.size(), 4U);
  const DepthEstimate& last = estimates.back();
  EXPECT_EQ(last.verdict, DepthVerdict::Found);
  EXPECT_NEAR(last.depth, 9e-3, 4 * last.depth_stddev);
  EXPECT_LT(last.depth_stddev, 1e-3);
  EXPECT_LT(last.depth_low, last.depth);
  EXPECT_GT(last.depth_high, last.depth);
}

TEST(BayesEstimatorTest, EveryTapMakesItSurer) {
  const auto estimates = estimates_over("ball depth=9 radius=8 ratio=200", {});
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_LT(estimates.back().depth_stddev, estimates.front().depth_stddev);
}

/// The last estimate after `hesitant` taps and a smooth one, all over the inclusion.
DepthEstimate after_hesitant(int hesitant, int* refused) {
  const auto phantom = plain_at_a("ball depth=9 radius=8 ratio=200");
  EXPECT_TRUE(phantom);
  depth::DepthEstimatorConfig config = knowing();
  config.bayes.stiffness.scale_stddev = 2e-3;
  depth::DepthEstimator estimator{config};
  Tapping tapping = kTaps;
  tapping.taps = hesitant + 1;
  tapping.hesitant = hesitant;
  DepthEstimate last;
  feel_taps(*phantom, {}, tapping, {}, [&](const ContactSample& sample) {
    const auto estimate = estimator.add(sample);
    if (estimate && estimate->reason == DepthReason::StrokeNotMonotone) ++*refused;
    if (estimate) last = *estimate;
  });
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

/// The estimates of so many taps over the inclusion, the surface 2 mm deeper than at first.
std::vector<DepthEstimate> tapped_over(depth::DepthEstimator& estimator,
                                       const Tapping& tapping,
                                       TimePoint* now) {
  const auto phantom = plain_at_a("ball depth=9 radius=8 ratio=200");
  EXPECT_TRUE(phantom);
  std::vector<DepthEstimate> out;
  *now = feel_taps(
      *phantom, {.surface_offset = 2e-3}, tapping, *now, [&](const ContactSample& sample) {
        if (const auto estimate = estimator.add(sample)) out.push_back(*estimate);
      });
  return out;
}

/// Of long palpations only sums are kept, and of those half is forgotten now and then.
TEST(BayesEstimatorTest, FortyTapsKnowNoLessThanSixteen) {
  depth::DepthEstimatorConfig config = knowing();
  config.bayes.stiffness.scale_stddev = 1e-3;
  depth::DepthEstimator estimator{config};
  TimePoint now{};
  Tapping tapping = kTaps;
  tapping.taps = 40;
  const auto estimates = tapped_over(estimator, tapping, &now);
  ASSERT_EQ(estimates.size(), 40U);
  EXPECT_LT(estimates[15].depth_stddev, 0.8 * estimates[3].depth_stddev);
  for (std::size_t i = 15; i < estimates.size(); ++i) {
    EXPECT_LT(estimates[i].depth_stddev, 1.05 * estimates[15].depth_stddev) << i;
    EXPECT_NEAR(estimates[i].depth, 9e-3, 4 * estimates[i].depth_stddev) << i;
  }
}

TEST(BayesEstimatorTest, AStrokeTooShortForAnAnswerDoesNotMisleadTheNext) {
  depth::DepthEstimatorConfig config = knowing();
  config.bayes.stiffness.scale_stddev = 1e-3;
  depth::DepthEstimator estimator{config};
  TimePoint now{};
  Tapping tapping = kTaps;
  tapping.taps = 1;
  tapping.indentation = 1.3e-3;
  const auto first = tapped_over(estimator, tapping, &now);
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(first.front().reason, DepthReason::StrokeTooShort);
  const auto next = tapped_over(estimator, kTaps, &now);
  ASSERT_EQ(next.size(), 4U);
  EXPECT_EQ(next.front().verdict, DepthVerdict::Found);
  EXPECT_NEAR(next.front().depth, 9e-3, 4 * next.front().depth_stddev);
}

TEST(BayesEstimatorTest, WithoutInclusionItSaysWhatIsExcluded) {
  const auto estimates = estimates_over("none", {});
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_EQ(estimates.back().verdict, DepthVerdict::None);
  EXPECT_GT(estimates.back().depth_low, 5e-3);
}

TEST(BayesEstimatorTest, WithoutNoiseItGivesBackThePhantom) {
  SimulatedPhantomConfig sensor;
  sensor.force_noise = 1e-4;
  sensor.force_quantum = 0;
  const auto estimates = estimates_over("ball depth=12.3 radius=8 ratio=200", sensor);
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
