#include "fem/sphere_contact.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "fem/gauss_rule.h"

namespace palp::fem {
namespace {

// Of Young's modulus over the tip's radius: 15 MPa/mm on the paper's phantom. The mean pressure is
// a third of E at most, so the overlap stays below 1e-4 radii.
constexpr double kPenalty = 5000;

}  // namespace

SphereContact::SphereContact(const Mesh& mesh, const Specimen& specimen)
    : radius_{specimen.indenter.radius},
      penalty_{kPenalty * specimen.block.youngs_modulus / specimen.indenter.radius} {
  for (const SurfaceEdge& edge : mesh.surface) {
    const auto r = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(edge[i])].r; };
    // The surface is drawn inward while it sinks: what lay beyond the tip's radius may touch it.
    if (r(0) > 1.1 * radius_) break;
    const int first = static_cast<int>(nodes_.size()) - (nodes_.empty() ? 0 : 1);
    nodes_.insert(nodes_.end(), edge.begin() + (nodes_.empty() ? 0 : 1), edge.end());
    // The contact's edge lies somewhere inside an element, and the force must not feel where.
    for (const auto& [t, weight] : kGaussFive) {
      Point point;
      point.nodes = {first, first + 1, first + 2};
      point.shape = {0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)};
      for (std::size_t i = 0; i < 3; ++i) point.r += point.shape[i] * r(i);
      const double slope = (t - 0.5) * r(0) - 2 * t * r(1) + (t + 0.5) * r(2);
      point.area = 2 * std::numbers::pi * point.r * slope * weight;
      points_.push_back(point);
    }
  }
}

SphereContact::Overlap SphereContact::overlap(const Point& point,
                                              const Eigen::VectorXd& displacement,
                                              double indentation) const {
  double r = point.r;
  double z = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    r += point.shape[i] * displacement[2 * point.nodes[i]];
    z += point.shape[i] * displacement[2 * point.nodes[i] + 1];
  }
  z -= radius_ - indentation;  // from the centre
  const double distance = std::hypot(r, z);
  // Far above the tip's equator there is no contact, whatever the mesh does.
  if (z > 0) return {.depth = -1, .normal_r = 0, .normal_z = -1, .distance = distance};
  return {.depth = radius_ - distance,
          .normal_r = r / distance,
          .normal_z = z / distance,
          .distance = distance};
}

SphereContact::Load SphereContact::measure(const Eigen::VectorXd& displacement,
                                           double indentation) const {
  Load load;
  double last_gap = 0;
  double last_r = 0;
  bool inside = false;
  for (const Point& point : points_) {
    const Overlap at = overlap(point, displacement, indentation);
    if (at.depth > 0) {
      load.energy += 0.5 * penalty_ * at.depth * at.depth * point.area;
      load.force -= penalty_ * at.depth * at.normal_z * point.area;
      load.contact_radius = point.r;
      ++load.touching;
    } else if (inside) {  // between this point and the one before
      load.contact_radius = last_r + (point.r - last_r) * last_gap / (last_gap - at.depth);
    }
    inside = at.depth > 0;
    last_gap = at.depth;
    last_r = point.r;
  }
  return load;
}

void SphereContact::add(const Eigen::VectorXd& displacement,
                        double indentation,
                        Eigen::MatrixXd& tangent,
                        Eigen::VectorXd& force) const {
  for (const Point& point : points_) {
    const Overlap at = overlap(point, displacement, indentation);
    if (!(at.depth > 0)) continue;
    const double stiff = penalty_ * point.area;
    const double push = stiff * at.depth;
    const double bend = push / at.distance;  // the normal turns as the point slides
    const Eigen::Vector2d normal{at.normal_r, at.normal_z};
    const Eigen::Matrix2d local =
        (stiff + bend) * normal * normal.transpose() - bend * Eigen::Matrix2d::Identity();
    for (std::size_t i = 0; i < 3; ++i) {
      force.segment<2>(2 * point.nodes[i]) -= push * point.shape[i] * normal;
      for (std::size_t j = 0; j < 3; ++j) {
        tangent.block<2, 2>(2 * point.nodes[i], 2 * point.nodes[j]) +=
            point.shape[i] * point.shape[j] * local;
      }
    }
  }
}

void SphereContact::add(const Eigen::VectorXd& displacement,
                        double indentation,
                        Eigen::VectorXd& force) const {
  for (const Point& point : points_) {
    const Overlap at = overlap(point, displacement, indentation);
    if (!(at.depth > 0)) continue;
    const double push = penalty_ * point.area * at.depth;
    for (std::size_t i = 0; i < 3; ++i) {
      force[2 * point.nodes[i]] -= push * point.shape[i] * at.normal_r;
      force[2 * point.nodes[i] + 1] -= push * point.shape[i] * at.normal_z;
    }
  }
}

}  // namespace palp::fem
