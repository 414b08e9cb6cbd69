#include "fem/harmonic_kernel.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/core/matrix3.h"
#include "fem/dense_solver.h"

namespace palp::fem {
namespace {

Specimen with_ball(double radius_mm, double depth_mm, double ratio) {
  Specimen specimen;
  specimen.inclusion = {.shape = InclusionShape::Ball,
                        .depth = depth_mm * 1e-3,
                        .radius = radius_mm * 1e-3,
                        .ratio = ratio};
  return specimen;
}

std::vector<SurfacePoint> some_points() {
  return {{0, 0}, {2e-3, 0.4}, {4.1e-3, 2.9}, {7e-3, -1.2}, {11e-3, 1.9}, {16e-3, 0.1}};
}

TEST(HarmonicKernelTest, AStiffBallStiffensWhateverPressesTheSurface) {
  const HarmonicKernel kernel{with_ball(8, 6, 100), 20e-3, Accuracy::Coarse};
  EXPECT_GE(kernel.reach(), 20e-3);
  const Eigen::MatrixXd change = kernel.between(some_points());
  EXPECT_LT((change - change.transpose()).norm(), 1e-8 * change.norm());
  EXPECT_LT(spectrum_of(change).values.maxCoeff(), 0);
}

TEST(HarmonicKernelTest, ABallAsSoftAsTheBlockChangesNothing) {
  const HarmonicKernel kernel{with_ball(8, 6, 1), 12e-3, Accuracy::Coarse};
  const HarmonicKernel stiff{with_ball(8, 6, 2), 12e-3, Accuracy::Coarse};
  EXPECT_LT(kernel.amplitude(0).norm(), 1e-9 * stiff.amplitude(0).norm());
}

// A force shared with its image at -phi sinks a point as the mean of both does.
TEST(HarmonicKernelTest, MirroredIsTheMeanOverAForceAndItsImage) {
  const HarmonicKernel kernel{with_ball(5, 5, 856), 20e-3, Accuracy::Coarse};
  std::vector<SurfacePoint> points = some_points();
  const auto count = static_cast<Eigen::Index>(points.size());
  const Eigen::MatrixXd mirrored = kernel.mirrored(points);
  for (std::size_t i = 0; i < some_points().size(); ++i) {
    points.push_back({points[i].r, -points[i].phi});
  }
  const Eigen::MatrixXd whole = kernel.between(points);
  const Eigen::MatrixXd mean =
      0.5 * (whole.topLeftCorner(count, count) + whole.topRightCorner(count, count));
  EXPECT_LT((mirrored - mean).norm(), 1e-12 * mean.norm());
}

// The harmonics of a ball fall as (a / (a + z))^(2 n) beside it, and what is left out is little.
TEST(HarmonicKernelTest, HarmonicsFallAndTheLastIsSmall) {
  for (const Specimen& specimen : {with_ball(5, 5, 856), with_ball(15, 10, 856)}) {
    const HarmonicKernel kernel{specimen, 20e-3, Accuracy::Coarse};
    EXPECT_EQ(kernel.orders(), harmonics_wanted(specimen.inclusion));
    EXPECT_LT(kernel.last_share(), 1e-4);
    const Inclusion& ball = specimen.inclusion;
    const double share = ball.radius / (ball.radius + ball.depth);
    for (int order = 2; order < kernel.orders(); ++order) {
      const double fall = kernel.amplitude(order).cwiseAbs().maxCoeff() /
                          kernel.amplitude(order - 1).cwiseAbs().maxCoeff();
      EXPECT_LT(fall, share * share) << order;
    }
  }
  EXPECT_LE(harmonics_wanted(with_ball(16, 0.5, 900).inclusion), 17);
}

/// Eshelby's ball in an incompressible half space under unit forces at two places on its surface,
/// to first order in (radius / depth)^3: the strain of the force at the centre, radial,
/// 9 cos t / (4 pi R^2 E) (n n - 1/3), times that of the other.
double dilute_kernel(const Specimen& specimen, const SurfacePoint& s, const SurfacePoint& t) {
  const Inclusion& ball = specimen.inclusion;
  const double depth = ball.depth + ball.radius;
  const double modulus = specimen.block.youngs_modulus;
  const auto ray = [&](const SurfacePoint& from) {
    return Vector3{-from.r * std::cos(from.phi), -from.r * std::sin(from.phi), -depth};
  };
  const auto dot = [](const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const Vector3 a = ray(s);
  const Vector3 b = ray(t);
  const auto strain = [&](const Vector3& r) {
    return 9 * depth / std::sqrt(dot(r, r)) / (4 * std::numbers::pi * dot(r, r) * modulus);
  };
  const double along = dot(a, b) * dot(a, b) / (dot(a, a) * dot(b, b)) - 1.0 / 3;
  const double volume = 4.0 / 3 * std::numbers::pi * std::pow(ball.radius, 3);
  const double contrast = (ball.ratio - 1) / (ball.ratio + 1.5);
  return -5 * modulus / 3 * contrast * volume * strain(a) * strain(b) * along;
}

TEST(HarmonicKernelTest, ASmallBallIsEshelbysAndGoesByItsContrast) {
  Specimen specimen = with_ball(2, 18, 856);
  specimen.block = {.half_width = 0.4, .height = 0.4, .youngs_modulus = 15.3e3, .poisson = 0.4999};
  specimen.inclusion.poisson = 0.4999;
  const std::vector<SurfacePoint> points{{0, 0}, {8e-3, 0}, {8e-3, 1}, {20e-3, 2.5}};
  const HarmonicKernel kernel{specimen, 24e-3, Accuracy::Coarse};
  const Eigen::MatrixXd found = kernel.between(points);
  specimen.inclusion.ratio = 3;
  const HarmonicKernel soft{specimen, 24e-3, Accuracy::Coarse};
  const Eigen::MatrixXd softer = soft.between(points);
  const double above = dilute_kernel(specimen, points[0], points[0]);
  for (Eigen::Index i = 0; i < found.rows(); ++i) {
    for (Eigen::Index j = 0; j < found.cols(); ++j) {
      specimen.inclusion.ratio = 856;
      const double wanted = dilute_kernel(
          specimen, points[static_cast<std::size_t>(i)], points[static_cast<std::size_t>(j)]);
      specimen.inclusion.ratio = 3;
      const double wanted_soft = dilute_kernel(
          specimen, points[static_cast<std::size_t>(i)], points[static_cast<std::size_t>(j)]);
      const double tolerance = 0.03 * std::abs(wanted) + 0.005 * std::abs(above);
      EXPECT_NEAR(found(i, j), wanted, tolerance) << i << ' ' << j;
      EXPECT_NEAR(softer(i, j), wanted_soft, tolerance) << i << ' ' << j;
    }
  }
  EXPECT_NEAR(found(0, 0) / softer(0, 0) / ((855 / 857.5) / (2 / 4.5)), 1, 0.005);
}

}  // namespace
}  // namespace palp::fem
