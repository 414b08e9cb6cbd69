#include "fem/surface_patch.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fem/dense_solver.h"
#include "fem/specimen.h"

namespace palp::fem {
namespace {

constexpr double kModulus = 20e3;  // [Pa]
constexpr double kTip = 5e-3;      // [m]

double parabola(double r) { return r * r / (2 * kTip); }

// Johnson: the middle of a square sinks by 8 ln(1 + sqrt 2) half / pi; far away it is a point
// force.
TEST(SurfacePatchTest, ASquareOfPressureSinksAsLoveSays) {
  const double half = 0.15e-3;
  EXPECT_NEAR(love_sinking(0, 0, half) * std::numbers::pi / half,
              8 * std::log(1 + std::numbers::sqrt2),
              1e-12);
  const double far = love_sinking(2.0e-3, 1.5e-3, half);
  EXPECT_NEAR(far * std::numbers::pi * 2.5e-3 / (4 * half * half), 1, 2e-3);
  EXPECT_NEAR(love_sinking(0.2e-3, 0.3e-3, half), love_sinking(-0.3e-3, 0.2e-3, half), 1e-18);
}

TEST(SurfacePatchTest, ComplianceIsSymmetricAndPositive) {
  const SurfacePatch patch{2e-3, 0.4e-3};
  const Eigen::MatrixXd compliance = patch.half_space(kModulus);
  EXPECT_EQ((compliance - compliance.transpose()).norm(), 0);
  EXPECT_GT(spectrum_of(compliance).values.minCoeff(), 0);
}

// F = 4/3 E* sqrt(R) d^1.5, contact radius sqrt(R d).
TEST(SurfacePatchTest, ParabolaFollowsHertz) {
  const SurfacePatch patch{4e-3, 0.3e-3};
  const Eigen::MatrixXd compliance = patch.half_space(kModulus);
  for (const double depth : {1e-3, 2e-3}) {
    const auto press = patch.press(compliance, parabola, depth);
    ASSERT_TRUE(press);
    const double wanted = 4.0 / 3 * kModulus * std::sqrt(kTip) * std::pow(depth, 1.5);
    EXPECT_NEAR(press->force / wanted, 1, 3e-3);
    EXPECT_NEAR(press->area / (std::numbers::pi * kTip * depth), 1, 0.05);
  }
  EXPECT_EQ(patch.press(compliance, parabola, 0)->force, 0);
}

// A constant added to the compliance lets the tip sink by that times the force, and no more.
TEST(SurfacePatchTest, AConstantSinkingIsALesserDepth) {
  const SurfacePatch patch{4e-3, 0.3e-3};
  const Eigen::MatrixXd compliance = patch.half_space(kModulus);
  const double constant = 1e-3;  // [m/N]
  const auto shallow = patch.press(compliance, parabola, 1.5e-3);
  ASSERT_TRUE(shallow);
  const Eigen::MatrixXd softer = compliance.array() + constant;
  const auto press = patch.press(softer, parabola, 1.5e-3 + constant * shallow->force);
  ASSERT_TRUE(press);
  EXPECT_NEAR(press->force / shallow->force, 1, 1e-9);
}

TEST(SurfacePatchTest, RefusesAContactThatOutgrowsIt) {
  const SurfacePatch patch{2e-3, 0.2e-3};
  const auto press = patch.press(patch.half_space(kModulus), parabola, 2e-3);
  ASSERT_FALSE(press);
  EXPECT_NE(press.error().text.find("farther than 2 mm"), std::string::npos);
}

}  // namespace
}  // namespace palp::fem
