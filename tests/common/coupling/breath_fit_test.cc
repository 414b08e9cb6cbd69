#include "common/coupling/breath_fit.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::coupling {
namespace {

constexpr double kStiffness = 0.1;  // [N], of the first shape

double swings(double at) { return 0.7e-3 * std::sin(1.6 * at); }

BreathSample tap(double at) {
  const double tip = 1.5e-3 + 2e-3 * std::sin(6 * at);
  const double xi = std::max(0.0, 1e3 * (tip - swings(at)));
  return {at, tip, kStiffness * xi * std::sqrt(xi / (1 + xi / kModelBend)), {}};
}

/// Some times through 12 s of taps.
BreathFit fitted(BreathFit fit, const BreathPrior& prior) {
  fit.suppose(prior.tissue);
  for (int round = 0; round < 40; ++round) {
    fit.begin();
    for (int i = 0; i < 300; ++i) fit.add(tap(0.04 * i), true);
    fit.improve(prior);
  }
  return fit;
}

TEST(BreathFitTest, FindsTheTissueAndWhereItsSurfaceIs) {
  const BreathFit fit = fitted({1.5, 0.2}, first_breath_prior());
  EXPECT_NEAR(fit.tissue()[0], kStiffness, 0.1 * kStiffness);
  const double at = 0.04 * 299;
  EXPECT_NEAR(fit.tissue()[kBreathSurface] + fit.at(at).displacement(), 1e3 * swings(at), 0.1);
  EXPECT_NEAR(fit.tissue()[kBreathRate], 1.6, 0.05);
  const BreathFit rest = fitted({}, first_breath_prior());
  EXPECT_LT(fit.square(), 0.1 * rest.square());
}

TEST(BreathFitTest, APlaceNearAKnownOneIsExpectedToBeLikeItAndAFarOneLess) {
  const BreathPrior found = fitted({1.5, 0.2}, first_breath_prior()).found();
  const BreathPrior near = prior_beside(found, 1e-3);
  const BreathPrior far = prior_beside(found, 20e-3);
  EXPECT_EQ(near.tissue, found.tissue);
  EXPECT_LT(near.closely[0][0], found.closely[0][0]);
  EXPECT_GT(near.closely[0][0], 2 * far.closely[0][0]);
}

TEST(BreathFitTest, ASupposedTissueKeepsThePace) {
  BreathFit fit{1.5, 0.2};
  fit.suppose({0.3, 0, 0, 2, 0, 0, 9});
  EXPECT_EQ(fit.tissue()[0], 0.3);
  EXPECT_EQ(fit.tissue()[kBreathRate], 1.5);
  fit.seek(3e-3, 0.3, 0.5e-3);
  EXPECT_NEAR(fit.tissue()[kBreathSurface], 1.5, 0.1) << "1 mm deep";
}

}  // namespace
}  // namespace palp::coupling
