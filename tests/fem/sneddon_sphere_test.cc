#include "fem/sneddon_sphere.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

constexpr SneddonSphere kSphere{.radius = 5e-3, .modulus = 20e3};

double hertz(double radius, double indentation) {
  return 4.0 / 3 * kSphere.modulus * std::sqrt(radius) * std::pow(indentation, 1.5);
}

TEST(SneddonSphereTest, IsHertzWhileShallowAndSofterBeyond) {
  EXPECT_NEAR(kSphere.press(1e-6).force / hertz(5e-3, 1e-6), 1, 1e-4);
  EXPECT_NEAR(kSphere.press(1e-6).contact_radius / std::sqrt(5e-3 * 1e-6), 1, 1e-4);
  EXPECT_LT(kSphere.press(2e-3).force, hertz(5e-3, 2e-3));
  EXPECT_EQ(kSphere.press(0).force, 0);
}

// Every axisymmetric contact of a half space grows stiffer as its radius: dF/dd = 2 E* a.
TEST(SneddonSphereTest, TheSlopeOfTheForceIsTheContactsDiameter) {
  SneddonSphere dome = kSphere;
  dome.surface_curvature = 16;
  SneddonSphere hollow = kSphere;
  hollow.surface_curvature = -16;
  for (const SneddonSphere& law : {kSphere, dome, hollow}) {
    for (const double indentation : {0.3e-3, 2e-3, 4e-3}) {
      const double step = 1e-8;
      const double slope =
          (law.press(indentation + step).force - law.press(indentation - step).force) / (2 * step);
      const double wanted = 2 * law.modulus * law.press(indentation).contact_radius;
      EXPECT_NEAR(slope / wanted, 1, 1e-5);
    }
  }
}

// On a parabola a shallow sphere is one of the radius 1 / (1/R + 1/Rs).
TEST(SneddonSphereTest, ADomeIsATipOfLessRadius) {
  SneddonSphere dome = kSphere;
  dome.surface_curvature = 1 / 60e-3;
  EXPECT_NEAR(dome.press(1e-6).force / hertz(1 / (1 / 5e-3 + 1 / 60e-3), 1e-6), 1, 1e-4);
}

TEST(SneddonSphereTest, AConstantIsADepthThatGoesByTheForce) {
  SneddonSphere block = kSphere;
  block.constant = -0.3e-3;
  const auto press = block.press(2e-3);
  const auto half_space = kSphere.press(2e-3 + 0.3e-3 * press.force);
  EXPECT_NEAR(press.force / half_space.force, 1, 1e-12);
  EXPECT_GT(press.force, kSphere.press(2e-3).force);
}

}  // namespace
}  // namespace palp::fem
