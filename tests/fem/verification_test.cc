#include "fem/verification.h"

#include <cmath>

#include <gtest/gtest.h>

#include "fem/bonded_layer.h"
#include "fem/verify_command.h"

namespace palp::fem {
namespace {

void expect_all(const Checks& checks) {
  EXPECT_FALSE(checks.empty());
  for (const Check& check : checks) {
    EXPECT_TRUE(check.passed()) << check.law << ": " << check.quantity << " is " << check.found
                                << ", wanted " << check.wanted << " +- " << check.tolerance;
  }
}

TEST(VerificationTest, ElementsKeepTheLawsOfElasticity) {
  expect_all(elastic_checks(Extent::Quick));
}
TEST(VerificationTest, FiniteStrainKeepsItsLaws) { expect_all(finite_checks(Extent::Quick)); }
TEST(VerificationTest, ContactKeepsItsLaws) { expect_all(contact_checks(Extent::Quick)); }

TEST(VerificationTest, ACheckFailsBeyondItsToleranceAndOnNoNumber) {
  EXPECT_TRUE(close("", "", 1.009, 1, 0.01).passed());
  EXPECT_FALSE(close("", "", 1.011, 1, 0.01).passed());
  EXPECT_FALSE(close("", "", std::nan(""), 1, 0.01).passed());
  EXPECT_TRUE(order("", "", 8, 1.05, 2, 3).passed());
  EXPECT_FALSE(order("", "", 8, 1.5, 2, 3).passed());
}

TEST(VerificationTest, TheReportCountsWhatWasMissed) {
  const std::string report =
      verify_report({close("a", "b", 2, 1, 0.1), close("c", "d", 1, 1, 0.1)});
  EXPECT_NE(report.find("\"schema\": \"palp.verify/1\""), std::string::npos);
  EXPECT_NE(report.find("\"missed\": 1"), std::string::npos);
  EXPECT_NE(verify_table({close("a", "b", 2, 1, 0.1)}).find("MISS"), std::string::npos);
}

// A layer much higher than the contact is a half-space (Sneddon), a thin one is stiffer.
TEST(BondedLayerTest, ThickLayersAreHalfSpacesAndThinOnesStiffer) {
  const double a = 2e-3;
  const double radius = 5e-3;
  const double wall = std::log((radius + a) / (radius - a));
  const double modulus = 15.3e3 / (1 - 0.49 * 0.49);
  const auto thick = BondedLayer{50, 15.3e3, 0.49, radius}.pressed_to(a);
  EXPECT_NEAR(thick.indentation / (0.5 * a * wall), 1, 1e-3);
  EXPECT_NEAR(
      thick.force / (modulus * (0.5 * (a * a + radius * radius) * wall - a * radius)), 1, 1e-3);
  const BondedLayer thin{10e-3, 15.3e3, 0.49, radius};
  EXPECT_GT(thin.force(1e-3), 1.2 * BondedLayer({50, 15.3e3, 0.49, radius}).force(1e-3));
}

}  // namespace
}  // namespace palp::fem
