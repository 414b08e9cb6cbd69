#include "fem/linear_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/SparseCholesky>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "fem/dense_solver.h"

namespace palp::fem {
namespace {

constexpr int kActiveSetPassesMax = 60;  // of the active set; a handful is usual

}  // namespace

std::vector<Material> materials_of(const Specimen& specimen) {
  const Block& block = specimen.block;
  return {{block.youngs_modulus, block.poisson},
          {block.youngs_modulus * specimen.inclusion.ratio, specimen.inclusion.poisson}};
}

LinearContact::LinearContact(const Mesh& mesh, const Specimen& specimen, double indentation_max)
    : assembler_{mesh, materials_of(specimen), bonded_base(mesh)} {
  collect_nodes(mesh, specimen, indentation_max);
  SparseMatrix stiffness = assembler_.pattern();
  Eigen::VectorXd force;
  assembler_.assemble(
      Strain::Small, Eigen::VectorXd::Zero(assembler_.components()), stiffness, force);
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower> factor{stiffness};
  PALP_CHECK(factor.info() == Eigen::Success, "the stiffness of a bonded block is regular");
  const auto count = static_cast<Eigen::Index>(contact_.size());
  response_.resize(assembler_.equations(), count);
  compliance_.resize(count, count);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(assembler_.equations());
  for (Eigen::Index j = 0; j < count; ++j) {
    const int loaded = assembler_.equation(z_of(contact_[static_cast<std::size_t>(j)].node));
    unit[loaded] = 1;
    response_.col(j) = factor.solve(unit);
    unit[loaded] = 0;
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const int row = assembler_.equation(z_of(contact_[static_cast<std::size_t>(i)].node));
    compliance_.row(i) = response_.row(row);
  }
  asymmetry_ = (compliance_ - compliance_.transpose()).norm() / compliance_.norm();
  compliance_ = 0.5 * (compliance_ + compliance_.transpose()).eval();
  force_ = Eigen::VectorXd::Zero(count);
  active_.assign(contact_.size(), false);
}

void LinearContact::collect_nodes(const Mesh& mesh,
                                  const Specimen& specimen,
                                  double indentation_max) {
  // The surface sinks round the contact, so nothing beyond the tip's own width at z = 0 is touched.
  for (const SurfaceEdge& edge : mesh.surface) {
    for (std::size_t k = contact_.empty() ? 0 : 1; k < 3; ++k) {
      const double r = mesh.nodes[static_cast<std::size_t>(edge[k])].r;
      const double profile = specimen.indenter.profile(r);
      if (!(profile < indentation_max) && contact_.size() >= 5) return;
      contact_.push_back({edge[k], r, profile});
    }
  }
}

bool LinearContact::solve_active(double indentation) {
  std::vector<Eigen::Index> on;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (active_[i]) on.push_back(static_cast<Eigen::Index>(i));
  }
  force_.setZero();
  if (on.empty()) return true;
  const auto count = static_cast<Eigen::Index>(on.size());
  Eigen::MatrixXd matrix(count, count);
  Eigen::VectorXd push(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto node = on[static_cast<std::size_t>(i)];
    push[i] = indentation - contact_[static_cast<std::size_t>(node)].profile;
    for (Eigen::Index j = 0; j < count; ++j) {
      matrix(i, j) = compliance_(node, on[static_cast<std::size_t>(j)]);
    }
  }
  const auto solution = solve_symmetric(matrix, push);
  if (!solution) return false;
  for (Eigen::Index i = 0; i < count; ++i) force_[on[static_cast<std::size_t>(i)]] = (*solution)[i];
  return true;
}

bool LinearContact::update_active(double indentation) {
  const Eigen::VectorXd sunk = compliance_ * force_;
  bool changed = false;
  // The axis node carries no force of its own in a quadratic axisymmetric element (its weight
  // integral of N r dr is zero): it goes with its neighbour.
  for (std::size_t i = 1; i < active_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double overlap = indentation - contact_[i].profile - sunk[k];
    const bool on = active_[i] ? force_[k] > 0 : overlap > 1e-9 * indentation;
    changed |= on != active_[i];
    active_[i] = on;
  }
  active_[0] = active_[1];
  return changed;
}

Result<CurveRow> LinearContact::press(double indentation) {
  if (!(indentation > 0)) {
    force_.setZero();
    active_.assign(active_.size(), false);
    return CurveRow{.indentation = indentation};
  }
  // Hertz: contact ends where the profile is half the indentation.
  for (std::size_t i = 0; i < active_.size(); ++i) {
    active_[i] = i < 2 || contact_[i].profile < 0.5 * indentation;
  }
  for (int pass = 0; pass < kActiveSetPassesMax; ++pass) {
    if (!solve_active(indentation)) break;
    if (update_active(indentation)) continue;
    return CurveRow{.indentation = indentation,
                    .force = force_.sum(),
                    .contact_radius = contact_radius(indentation),
                    .error = 0};
  }
  char text[96];
  std::snprintf(text,
                sizeof text,
                "the contact does not settle at an indentation of %.6g mm",
                indentation / kMillimetre);
  return fail(text);
}

double LinearContact::contact_radius(double indentation) const {
  const Eigen::VectorXd sunk = compliance_ * force_;
  std::size_t last = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (active_[i]) last = i;
  }
  const double r = contact_[last].r;
  if (last + 2 >= contact_.size()) return r;
  // Outside the edge the gap opens like (r - a)^1.5.
  const auto gap = [&](std::size_t i) {
    const double value = contact_[i].profile - indentation + sunk[static_cast<Eigen::Index>(i)];
    return std::cbrt(std::max(0.0, value) * std::max(0.0, value));
  };
  const double near = gap(last + 1);
  const double far = gap(last + 2);
  if (!(far > near) || !std::isfinite(far)) return r;
  const double r1 = contact_[last + 1].r;
  const double edge = r1 - near * (contact_[last + 2].r - r1) / (far - near);
  return std::clamp(edge, r, r1);
}

Field LinearContact::field() const {
  const Eigen::VectorXd solution = -(response_ * force_);
  Field out(static_cast<std::size_t>(assembler_.components()));
  for (int i = 0; i < assembler_.components(); ++i) {
    const int equation = assembler_.equation(i);
    if (equation >= 0) out[static_cast<std::size_t>(i)] = solution[equation];
  }
  return out;
}

double LinearContact::energy() const { return 0.5 * force_.dot(compliance_ * force_); }

}  // namespace palp::fem
