#include "fem/harmonic_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/core/check.h"
#include "fem/harmonic_body.h"
#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

constexpr int kOrdersMax = 17;           // 0 to 16
constexpr double kSpacing = 0.3;         // of surface nodes, per tip radius: 1.5 mm
constexpr double kSpacingOfDepth = 0.5;  // the same, per depth of the inclusion's top
constexpr double kSpacingMin = 0.1;      // per tip radius
constexpr double kKnotsApart = 0.6;      // least distance of knots, per spacing of nodes

double spacing_of(const Specimen& specimen) {
  const double tip = specimen.indenter.radius;
  return std::clamp(kSpacingOfDepth * specimen.inclusion.depth, kSpacingMin * tip, kSpacing * tip);
}

/// Nodes from the axis to just beyond `reach`; under the tip the mesh has more than it takes.
std::vector<int> knot_nodes(const Mesh& mesh, double reach, double spacing) {
  std::vector<int> nodes{mesh.surface.front()[0]};
  double last = 0;
  for (const SurfaceEdge& edge : mesh.surface) {
    for (const std::size_t k : {1U, 2U}) {
      const double r = mesh.nodes[static_cast<std::size_t>(edge[k])].r;
      if (r < last + kKnotsApart * spacing) continue;
      nodes.push_back(edge[k]);
      last = r;
      if (last > reach) return nodes;
    }
  }
  return nodes;
}

}  // namespace

int harmonics_wanted(const Inclusion& ball) {
  const double fall = std::log((ball.radius + ball.depth) / ball.radius);
  return std::min(kOrdersMax, 3 + static_cast<int>(std::ceil(2 / fall)));
}

HarmonicKernel::HarmonicKernel(const Specimen& specimen, double reach, Accuracy accuracy) {
  PALP_CHECK(specimen.inclusion.shape == InclusionShape::Ball, "the harmonics are a ball's");
  const double spacing = spacing_of(specimen);
  // The spline is free at its end: two nodes beyond, nobody feels it.
  const double end = std::min(reach + 2 * spacing, 0.5 * (reach + specimen.block.half_width));
  const Mesh mesh = make_mesh(specimen, accuracy, {.reach = end, .spacing = spacing});
  const std::vector<int> nodes = knot_nodes(mesh, end, spacing);
  for (const int node : nodes) knots_.push_back(mesh.nodes[static_cast<std::size_t>(node)].r);
  HarmonicBody body{mesh, nodes};
  const std::vector<Material> with = materials_of(specimen);
  const std::vector<Material> without{with.front(), with.front()};
  for (int order = 0; order < harmonics_wanted(specimen.inclusion); ++order) {
    amplitudes_.push_back(body.compliance(with, order) - body.compliance(without, order));
  }
  splines_ = {{knots_, Parity::Even}, {knots_, Parity::Odd}};
}

double HarmonicKernel::last_share() const {
  const double first = amplitudes_.front().cwiseAbs().maxCoeff();
  return first > 0 ? amplitudes_.back().cwiseAbs().maxCoeff() / first : 0;
}

Eigen::MatrixXd HarmonicKernel::weights(const std::vector<SurfacePoint>& points, int order) const {
  std::vector<double> r;
  r.reserve(points.size());
  for (const SurfacePoint& point : points) r.push_back(point.r);
  return splines_[static_cast<std::size_t>(order % 2)].weights(r);
}

Eigen::MatrixXd HarmonicKernel::mirrored(const std::vector<SurfacePoint>& points) const {
  const auto count = static_cast<Eigen::Index>(points.size());
  const auto knots = static_cast<Eigen::Index>(knots_.size());
  const std::array<Eigen::MatrixXd, 2> spline{weights(points, 0), weights(points, 1)};
  // All harmonics side by side make one product.
  Eigen::MatrixXd left(count, knots * orders());
  Eigen::MatrixXd right(count, knots * orders());
  for (int order = 0; order < orders(); ++order) {
    Eigen::VectorXd cosine(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      cosine[i] = std::cos(order * points[static_cast<std::size_t>(i)].phi);
    }
    auto part = right.middleCols(order * knots, knots);
    part = cosine.asDiagonal() * spline[static_cast<std::size_t>(order % 2)];
    left.middleCols(order * knots, knots) = part * amplitude(order);
  }
  return left * right.transpose();
}

Eigen::MatrixXd HarmonicKernel::between(const std::vector<SurfacePoint>& points) const {
  const auto count = static_cast<Eigen::Index>(points.size());
  const std::array<Eigen::MatrixXd, 2> spline{weights(points, 0), weights(points, 1)};
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(count, count);
  for (int order = 0; order < orders(); ++order) {
    const Eigen::MatrixXd& weight = spline[static_cast<std::size_t>(order % 2)];
    const Eigen::MatrixXd term = weight * amplitude(order) * weight.transpose();
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < count; ++j) {
        const double between =
            points[static_cast<std::size_t>(i)].phi - points[static_cast<std::size_t>(j)].phi;
        out(i, j) += term(i, j) * std::cos(order * between);
      }
    }
  }
  return out;
}

}  // namespace palp::fem
