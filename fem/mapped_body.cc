#include "fem/mapped_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/SparseCholesky>

#include "fem/element.h"
#include "fem/gauss_rule.h"

namespace palp::fem {
namespace {

constexpr int kMappingPassesMax = 30;   // of Newton's method
constexpr double kResidualMax = 1e-13;  // of the residual, relative to the largest reaction

}  // namespace

MappedBody::MappedBody(int columns, int rows, const Placement& place, Material material)
    : columns_{columns}, rows_{rows}, material_{material}, other_{material} {
  const int width = 2 * columns + 1;
  for (int j = 0; j <= 2 * rows; ++j) {
    for (int i = 0; i < width; ++i) {
      mesh_.nodes.push_back(place(i / (2.0 * columns), j / (2.0 * rows)));
    }
  }
  mesh_.add_block(
      columns, rows, [&](int column, int row) { return row * width + column; }, 0);
  const auto count = static_cast<Eigen::Index>(2 * mesh_.nodes.size());
  fixed_.assign(2 * mesh_.nodes.size(), false);
  prescribed_ = Eigen::VectorXd::Zero(count);
  load_ = Eigen::VectorXd::Zero(count);
}

void MappedBody::embed(const Material& other, const std::function<bool(const Node&)>& inside) {
  other_ = other;
  for (Element& element : mesh_.elements) {
    element.material = inside(mesh_.nodes[static_cast<std::size_t>(element.nodes[4])]) ? 1 : 0;
  }
}

std::vector<int> MappedBody::nodes_of(Side side) const {
  const int width = 2 * columns_ + 1;
  const bool along_s = side == Side::TLow || side == Side::THigh;
  const int count = along_s ? width : 2 * rows_ + 1;
  std::vector<int> nodes;
  for (int i = 0; i < count; ++i) {
    switch (side) {
      case Side::SLow:
        nodes.push_back(i * width);
        break;
      case Side::SHigh:
        nodes.push_back(i * width + width - 1);
        break;
      case Side::TLow:
        nodes.push_back(i);
        break;
      case Side::THigh:
        nodes.push_back(2 * rows_ * width + i);
        break;
    }
  }
  return nodes;
}

void MappedBody::support_component(Side side, int axis, const VectorField& displacement) {
  for (const int node : nodes_of(side)) {
    const Vector2 value = displacement(mesh_.nodes[static_cast<std::size_t>(node)]);
    fixed_[static_cast<std::size_t>(r_of(node) + axis)] = true;
    prescribed_[r_of(node) + axis] = axis == 0 ? value.r : value.z;
  }
}

void MappedBody::support_r(Side side, const VectorField& displacement) {
  support_component(side, 0, displacement);
}
void MappedBody::support_z(Side side, const VectorField& displacement) {
  support_component(side, 1, displacement);
}
void MappedBody::support(Side side, const VectorField& displacement) {
  support_r(side, displacement);
  support_z(side, displacement);
}

void MappedBody::pull(Side side, const VectorField& traction) {
  const std::vector<int> nodes = nodes_of(side);
  for (std::size_t first = 0; first + 2 < nodes.size(); first += 2) {
    for (const auto& [x, weight] : kGaussFive) {
      const std::array<double, 3> value{0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)};
      const std::array<double, 3> slope{x - 0.5, -2 * x, x + 0.5};
      Node place;
      Node tangent;
      for (std::size_t k = 0; k < 3; ++k) {
        const Node& node = mesh_.nodes[static_cast<std::size_t>(nodes[first + k])];
        place.r += value[k] * node.r;
        place.z += value[k] * node.z;
        tangent.r += slope[k] * node.r;
        tangent.z += slope[k] * node.z;
      }
      const double area =
          2 * std::numbers::pi * place.r * std::hypot(tangent.r, tangent.z) * weight;
      const Vector2 t = traction(place);
      for (std::size_t k = 0; k < 3; ++k) {
        load_[r_of(nodes[first + k])] += area * value[k] * t.r;
        load_[z_of(nodes[first + k])] += area * value[k] * t.z;
      }
    }
  }
}

void MappedBody::fill(const VectorField& body_force) {
  for (const Element& element : mesh_.elements) {
    for (const auto& [xi, weight] : kGaussFive) {
      for (const auto& [eta, other_weight] : kGaussFive) {
        const Sample at = sample(element, prescribed_, xi, eta);
        const Vector2 force = body_force(at.place);
        const double volume =
            2 * std::numbers::pi * at.place.r * at.measure * weight * other_weight;
        for (std::size_t k = 0; k < 9; ++k) {
          load_[r_of(element.nodes[k])] += volume * at.shape.value[k] * force.r;
          load_[z_of(element.nodes[k])] += volume * at.shape.value[k] * force.z;
        }
      }
    }
  }
}

MappedBody::Solution MappedBody::solve(Strain strain) const {
  const Assembler assembler{mesh_, {material_, other_}, fixed_};
  Solution out;
  // At finite strain the supports' motion must not turn the elements beside them inside out.
  out.displacement = strain == Strain::Finite ? solve(Strain::Small).displacement : prescribed_;
  SparseMatrix tangent = assembler.pattern();
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> factor;
  factor.analyzePattern(tangent);
  Eigen::VectorXd force;
  for (int pass = 0; pass < kMappingPassesMax; ++pass) {
    if (!(assembler.assemble(strain, out.displacement, tangent, force).volume_ratio_min > 0)) break;
    out.reaction = force - load_;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(assembler.equations());
    for (int i = 0; i < assembler.components(); ++i) {
      if (assembler.equation(i) >= 0) right[assembler.equation(i)] = -out.reaction[i];
    }
    out.residuals.push_back(right.norm());
    const double scale = std::max(out.reaction.norm(), load_.norm());
    if (right.norm() <= kResidualMax * scale || (strain == Strain::Small && pass == 1)) {
      out.solved = true;
      break;
    }
    factor.factorize(tangent);
    if (factor.info() != Eigen::Success) break;
    const Eigen::VectorXd step = factor.solve(right);
    for (int i = 0; i < assembler.components(); ++i) {
      if (assembler.equation(i) >= 0) out.displacement[i] += step[assembler.equation(i)];
    }
    if (pass > 1 && step.norm() < 1e-14 * out.displacement.norm()) {
      out.solved = true;
      break;
    }
  }
  return out;
}

MappedBody::Sample MappedBody::sample(const Element& element,
                                      const Eigen::VectorXd& displacement,
                                      double xi,
                                      double eta) const {
  Sample at;
  at.shape = shape_at(xi, eta);
  Node along_xi;
  Node along_eta;
  for (std::size_t k = 0; k < 9; ++k) {
    const Node& node = mesh_.nodes[static_cast<std::size_t>(element.nodes[k])];
    at.place.r += at.shape.value[k] * node.r;
    at.place.z += at.shape.value[k] * node.z;
    along_xi.r += at.shape.xi[k] * node.r;
    along_xi.z += at.shape.xi[k] * node.z;
    along_eta.r += at.shape.eta[k] * node.r;
    along_eta.z += at.shape.eta[k] * node.z;
  }
  at.measure = along_xi.r * along_eta.z - along_xi.z * along_eta.r;
  at.f = kUndeformed;
  for (std::size_t k = 0; k < 9; ++k) {
    const double dr = (at.shape.xi[k] * along_eta.z - at.shape.eta[k] * along_xi.z) / at.measure;
    const double dz = (at.shape.eta[k] * along_xi.r - at.shape.xi[k] * along_eta.r) / at.measure;
    const double ur = displacement[r_of(element.nodes[k])];
    const double uz = displacement[z_of(element.nodes[k])];
    at.moved.r += at.shape.value[k] * ur;
    at.moved.z += at.shape.value[k] * uz;
    at.f[0] += dr * ur;
    at.f[1] += dz * ur;
    at.f[2] += dr * uz;
    at.f[3] += dz * uz;
  }
  // On the axis u_r / r is the slope.
  at.f[4] = at.place.r > 0 ? 1 + at.moved.r / at.place.r : at.f[0];
  return at;
}

MappedBody::Error MappedBody::error_of(const Eigen::VectorXd& found,
                                       const VectorField& exact,
                                       const std::function<Gradient(const Node&)>& gradient) const {
  double off = 0;
  double off_slope = 0;
  double all = 0;
  double all_slope = 0;
  for (const Element& element : mesh_.elements) {
    for (const auto& [xi, weight] : kGaussFive) {
      for (const auto& [eta, other_weight] : kGaussFive) {
        const Sample at = sample(element, found, xi, eta);
        const double volume = at.place.r * at.measure * weight * other_weight;
        const Vector2 wanted = exact(at.place);
        const Gradient slope = gradient(at.place);
        off += volume * (std::pow(at.moved.r - wanted.r, 2) + std::pow(at.moved.z - wanted.z, 2));
        all += volume * (wanted.r * wanted.r + wanted.z * wanted.z);
        for (std::size_t k = 0; k < 5; ++k) {
          off_slope += volume * std::pow(at.f[k] - kUndeformed[k] - slope[k], 2);
          all_slope += volume * slope[k] * slope[k];
        }
      }
    }
  }
  return {.l2 = std::sqrt(off / all), .h1 = std::sqrt(off_slope / all_slope)};
}

Gradient MappedBody::gradient_at(const Eigen::VectorXd& displacement, int node) const {
  Gradient sum{};
  int count = 0;
  for (const Element& element : mesh_.elements) {
    for (int k = 0; k < 9; ++k) {
      if (element.nodes[static_cast<std::size_t>(k)] != node) continue;
      const Gradient f = sample(element, displacement, k % 3 - 1, k / 3 - 1).f;
      for (std::size_t i = 0; i < 5; ++i) sum[i] += f[i];
      ++count;
    }
  }
  for (double& value : sum) value /= count;
  return sum;
}

}  // namespace palp::fem
