// Goal: the posterior of the depth means what it says. Method: distributions with known quantiles,
// and curves of the database given back to the model that was made of it.
#include "patient_site/estimator/depth_posterior.h"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::estimator {
namespace {

TEST(DepthDistributionTest, OneEvenMassHasTheQuantilesOfItsRange) {
  const DepthMass mass{.log_depth = std::log(10e-3), .width = 0.2, .log_mass = -3};
  const DepthDistribution depths{std::vector{mass}, 3e-3, 27e-3};
  EXPECT_NEAR(depths.log_total(), -3, 1e-9);
  EXPECT_NEAR(depths.quantile(0.5), 10e-3, 1e-5);
  EXPECT_NEAR(depths.quantile(0.025), 10e-3 * std::exp(-0.095), 2e-5);
  EXPECT_NEAR(depths.quantile(0.975), 10e-3 * std::exp(0.095), 2e-5);
}

TEST(DepthDistributionTest, NothingLiesOutsideTheRange) {
  const DepthMass mass{.log_depth = std::log(3.1e-3), .width = 0.5, .log_mass = 0};
  const DepthDistribution depths{std::vector{mass}, 3e-3, 27e-3};
  EXPECT_GE(depths.quantile(0.001), 3e-3 * (1 - 1e-9));
}

/// A ramp of masses over 5 to 10 mm, rising towards one end.
DepthDistribution rising(bool deeper, double low, double high) {
  std::vector<DepthMass> masses;
  for (int i = 0; i < 200; ++i) {
    const double depth = 5e-3 + (i + 0.5) * 25e-6;
    const double share = deeper ? i + 0.5 : 199.5 - i;
    masses.push_back({std::log(depth), 25e-6 / depth, std::log(share)});
  }
  return {masses, low, high};
}

/// Its cumulated share is a square, so that the quantiles are roots.
TEST(DepthDistributionTest, AnIntervalRunsToTheEndThatIsLikeliest) {
  const auto deep = rising(true, 3e-3, 10e-3).interval();
  EXPECT_EQ(deep.high, 10e-3);
  EXPECT_NEAR(deep.low, 5e-3 + 5e-3 * std::sqrt(0.05), 2e-5);
  const auto shallow = rising(false, 5e-3, 12e-3).interval();
  EXPECT_EQ(shallow.low, 5e-3);
  EXPECT_NEAR(shallow.high, 10e-3 - 5e-3 * std::sqrt(0.05), 2e-5);
}

TEST(DepthDistributionTest, AnIntervalWithinTheRangeLeavesLessAboveThanBelow) {
  const auto inside = rising(true, 3e-3, 12e-3).interval();
  EXPECT_NEAR(inside.low, 5e-3 + 5e-3 * std::sqrt(0.01), 2e-5);
  EXPECT_NEAR(inside.high, 5e-3 + 5e-3 * std::sqrt(0.96), 2e-5);
}

TEST(CurveLatticeTest, GivesBackTheCurvesOfTheDatabase) {
  const auto database = fem::default_database();
  ASSERT_TRUE(database);
  const CurveLattice lattice{*database, {}};
  const CurveBasis basis{*database};
  for (const double depth : {6.3e-3, 9.7e-3, 14.1e-3, 22e-3}) {
    for (const double radius : {3.7e-3, 8.1e-3, 14.3e-3}) {
      for (const double ratio : {5.0, 40.0, 700.0}) {
        const auto curve = database->curve({.depth = depth, .radius = radius, .ratio = ratio});
        const CurveTerms terms = lattice.at(std::log(depth), radius, effect_of(ratio));
        for (double d = 0.2e-3; d < 4e-3; d += 0.4e-3) {
          double force = 0;
          const CurveBasis::Row row = basis.at(d);
          for (std::size_t m = 0; m < kCurveTerms; ++m) force += row.force[m] * terms[m];
          // The noise leaves 0.4 mN of the mean of four strokes.
          EXPECT_NEAR(force, database->force(curve, d), 0.2e-3) << depth << ' ' << radius;
        }
      }
    }
  }
}

/// A slow stroke of 4 mm and back, without pole and steps.
Touch press(const fem::DepthDatabase& database,
            const fem::DepthDatabase::Curve& curve,
            double surface,
            double noise) {
  Touch touch;
  constexpr int kSamples = 1500;
  for (int i = 0; i < kSamples; ++i) {
    const double d = 4e-3 - 4.5e-3 * std::abs(1 - 2.0 * i / kSamples);
    const double error = noise * random_normal(1, 1, static_cast<std::uint64_t>(i));
    touch.push_back({.tip = surface + d, .force = database.force(curve, d) + error, .span = 1e-3});
  }
  return touch;
}

TEST(DepthModelTest, TheRangeOfSizesMakesTheIntervalWiderAndStillHoldsTheTruth) {
  const auto database = fem::default_database();
  ASSERT_TRUE(database);
  const auto curve = database->curve({.depth = 8e-3, .radius = 10e-3, .ratio = 100});
  constexpr double kNoise = 0.02;  // [N]
  const Touch touch = press(*database, curve, 0, kNoise);
  const DepthModel::Input input{.touches = std::span{&touch, 1},
                                .noise = kNoise,
                                .stiffness = {.scale_stddev = 0.003, .rate_factor = 0},
                                .expected = {}};
  const DepthPosterior known =
      DepthModel{*database,
                 {.radius_min = 10e-3, .radius_max = 10e-3, .ratio_min = 100, .ratio_max = 100}}
          .update(input);
  const DepthPosterior range = DepthModel{*database, {}}.update(input);
  EXPECT_NEAR(known.depth, 8e-3, 4 * known.depth_stddev);
  EXPECT_GT(range.depth_high - range.depth_low, 2 * (known.depth_high - known.depth_low));
  EXPECT_LT(range.depth_low, 8e-3);
  EXPECT_GT(range.depth_high, 8e-3);
  EXPECT_GT(range.log_evidence, 5);
}

TEST(DepthModelTest, TheSurfaceIsFoundFromAWrongGuess) {
  const auto database = fem::default_database();
  ASSERT_TRUE(database);
  const auto curve = database->curve({.depth = 8e-3, .radius = 10e-3, .ratio = 100});
  const Touch touch = press(*database, curve, 1.7e-3, 1e-4);
  const DepthModel model{
      *database, {.radius_min = 10e-3, .radius_max = 10e-3, .ratio_min = 100, .ratio_max = 100}};
  for (const double off : {-0.1e-3, 0.1e-3}) {
    const DepthPosterior posterior =
        model.update({.touches = std::span{&touch, 1},
                      .surface = 1.7e-3 + off,
                      .noise = 1e-4,
                      .stiffness = {.scale_stddev = 0.1, .rate_factor = 0},
                      .expected = {}});
    EXPECT_NEAR(posterior.best.surface, 1.7e-3, 5e-6) << off;
    EXPECT_NEAR(posterior.depth, 8e-3, 0.05e-3) << off;
  }
}

/// What was settled and what is looked at anew say together what all say at once.
TEST(DepthModelTest, SettledTouchesCountLikeOthers) {
  const auto database = fem::default_database();
  ASSERT_TRUE(database);
  const auto curve = database->curve({.depth = 8e-3, .radius = 10e-3, .ratio = 100});
  constexpr double kNoise = 0.02;  // [N]
  const std::vector<Touch> touches(3, press(*database, curve, 0, kNoise));
  const DepthModel model{*database, {}};
  DepthModel::Input input{
      .touches = touches, .noise = kNoise, .stiffness = {.rate_factor = 0}, .expected = {}};
  const DepthPosterior all = model.update(input);
  DepthModel::Input early = input;
  early.touches = input.touches.first(2);
  NormalEquations settled{0};
  TouchModel near = all.best;
  near.surface += 20e-6;
  model.settle(early, near, settled);
  input.touches = input.touches.last(1);
  input.settled = &settled;
  const DepthPosterior parts = model.update(input);
  EXPECT_NEAR(parts.depth, all.depth, 0.05 * all.depth_stddev);
  EXPECT_NEAR(parts.depth_stddev, all.depth_stddev, 0.02 * all.depth_stddev);
  EXPECT_NEAR(parts.best.surface, all.best.surface, 3e-6);
}

}  // namespace
}  // namespace palp::estimator
