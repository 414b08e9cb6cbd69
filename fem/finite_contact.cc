#include "fem/finite_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "fem/dense_solver.h"
#include "fem/linear_contact.h"
#include "fem/trailing_block.h"

namespace palp::fem {
namespace {

constexpr double kStepMax = 0.05;      // [radii]: 0.25 mm for the paper's tip
constexpr double kStepMin = 1e-4;      // [radii]
constexpr int kStepPassesMax = 12;     // of one step; 5 are usual
constexpr int kContactPassesMax = 25;  // on the dense surface; about 10 are usual
constexpr double kTolerance = 1e-5;    // of the residual, relative to the contact's force
constexpr int kPatience = 5;           // passes that cost as much as new factors
constexpr double kSlowest = 0.5;       // of the residual before, of a pass that makes its way
constexpr double kNear = 2;            // residual from which a state's own tangent is sound
constexpr double kSound = 1e-2;        // residual after one pass above which new factors pay
constexpr double kStuck = 0.01;        // change of the residual in two passes that is none
constexpr double kShift = 1e-6;        // of the surface's tangent where it is indefinite
constexpr double kSettled = 1e-12;     // of the penalty's energy: the contact has settled
constexpr double kShareMin = 1e-4;     // of a contact step: rounding is all that is left
constexpr int kCutsMax = 6;            // of a pass's step
constexpr double kOvershoot = 0.5;     // of the slope at the beginning of a pass's step

}  // namespace

FiniteContact::FiniteContact(const Mesh& mesh, const Specimen& specimen)
    : contact_{mesh, specimen},
      assembler_{mesh, materials_of(specimen), bonded_base(mesh), contact_.nodes()},
      tangent_{assembler_.pattern()},
      step_max_{kStepMax * specimen.indenter.radius},
      step_{0.4 * step_max_} {
  PALP_CHECK(specimen.indenter.shape == IndenterShape::Sphere, "model N knows the sphere");
  factor_.analyzePattern(tangent_);
  solved_.displacement = Eigen::VectorXd::Zero(assembler_.components());
  solved_.residual = Eigen::VectorXd::Zero(assembler_.equations());
  solved_.before = solved_.displacement;
  for (std::size_t i = 0; i < contact_.nodes().size(); ++i) {
    for (const int axis : {0, 1}) {
      if (assembler_.equation(r_of(contact_.nodes()[i]) + axis) < 0) continue;
      surface_place_.push_back(2 * static_cast<int>(i) + axis);
    }
  }
}

Result<CurveRow> FiniteContact::press(double indentation) {
  const double step_min = step_max_ * kStepMin / kStepMax;
  while (solved_.indentation < indentation) {
    const double left = indentation - solved_.indentation;
    // Equal steps up to the next row that was asked for.
    const double step = left / std::ceil(left / step_ - 1e-9);
    const bool last = step > left * (1 - 1e-9);
    State next = solved_;
    next.indentation = last ? indentation : solved_.indentation + step;
    if (solve(next)) {
      solved_ = std::move(next);
      step_ = std::min(step_max_, 1.5 * step_);
      continue;
    }
    step_ = 0.5 * step;
    if (step_ < step_min) {
      char text[160];
      std::snprintf(text,
                    sizeof text,
                    "no equilibrium found beyond an indentation of %.4g mm (asked for %.4g mm): "
                    "the tissue is squeezed too hard for the mesh",
                    solved_.indentation / kMillimetre,
                    indentation / kMillimetre);
      return fail(text);
    }
  }
  const SphereContact::Load load = contact_.measure(surface_of(solved_.displacement), indentation);
  return CurveRow{.indentation = indentation,
                  .force = load.force,
                  .contact_radius = load.contact_radius,
                  .error = 0};
}

bool FiniteContact::measure(State& state) const {
  Eigen::VectorXd force;
  const Assembler::Result elastic = assembler_.balance(state.displacement, force);
  if (!(elastic.volume_ratio_min > 0)) return false;
  state.elastic = elastic.energy;
  state.residual.resize(assembler_.equations());
  for (int i = 0; i < assembler_.components(); ++i) {
    if (assembler_.equation(i) >= 0) state.residual[assembler_.equation(i)] = force[i];
  }
  return std::isfinite(elastic.energy);
}

bool FiniteContact::solve(State& state) {
  residuals_.clear();
  cut_ = false;
  for (int pass = 0; pass < kStepPassesMax; ++pass) {
    const Eigen::VectorXd surface = surface_of(state.displacement);
    const SphereContact::Load load = contact_.measure(surface, state.indentation);
    const Eigen::VectorXd balance = balance_of(state);
    residuals_.push_back(balance.norm() / std::max(load.force, 1e-300));
    if (!std::isfinite(residuals_.back())) return false;
    if (load.touching > 0 && residuals_.back() < kTolerance) return true;
    if (stuck()) return false;
    if (!choose_factors(state)) return false;
    if (improve(state)) continue;
    // Factors of a guess may lack a stable surface; those of the last equilibrium have one.
    if (!factorize(solved_) || !improve(state)) return false;
  }
  return false;
}

/// Passes that were shortened until they changed nothing: the next would do the same. A smaller
/// step of indentation is cheaper.
bool FiniteContact::stuck() const {
  const std::size_t passes = residuals_.size();
  if (!cut_ || passes < 3) return false;
  const auto [low, high] = std::minmax_element(residuals_.end() - 3, residuals_.end());
  return *high - *low < kStuck * *high;
}

/// One pass by the factors there are, of a step ago, brings the last state near the new
/// equilibrium; then the state's own tangent is worth its price, and serves to the end of the step,
/// even where the pass left a residual as large as the contact's force: that is volume, second
/// order in the pass, which the next one takes back. New ones again where more passes are to be
/// expected than factors cost, or where a step had to be shortened.
bool FiniteContact::choose_factors(const State& state) {
  const std::size_t passes = residuals_.size();
  const double now = residuals_.back();
  if (factorizations_ == 0) return factorize(solved_);
  if (passes == 1) return true;
  const double rate = now / residuals_[passes - 2];
  const bool slow = rate > kSlowest || std::log(kTolerance / now) < kPatience * std::log(rate);
  if (!slow && !cut_ && !(passes == 2 && now > kSound)) return true;
  if (now < kNear && factorize(state)) return true;
  return factorize(solved_);
}

/// With the pressures that the last pass, linear in the displacements, led to.
bool FiniteContact::factorize(const State& state) {
  Eigen::VectorXd force;
  const std::vector<Pressure> pressures =
      assembler_.pressures_after(state.before, state.displacement - state.before);
  assembler_.assemble(state.displacement, pressures, tangent_, force);
  factor_.factorize(tangent_);
  ++factorizations_;
  of_equilibrium_ = &state == &solved_;
  if (factor_.info() != Eigen::Success) return false;
  condense();
  return true;
}

void FiniteContact::condense() {
  const int size = surface_count();
  surface_lower_ = trailing_block(factor_.matrixL().nestedExpression(), size);
  surface_stiffness_ =
      surface_lower_ * factor_.vectorD().tail(size).asDiagonal() * surface_lower_.transpose();
}

bool FiniteContact::improve(State& state) {
  const int size = surface_count();
  Eigen::VectorXd step = factor_.matrixL().solve(-state.residual);
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(2 * static_cast<int>(contact_.nodes().size()));
  if (!settle_contact(state, surface_lower_ * step.tail(size), increment)) return false;
  // The contact loads the last equations alone: the rest of the forward solve stands.
  const Eigen::VectorXd surface = surface_of(state.displacement);
  step.tail(size) -= surface_lower_.triangularView<Eigen::UnitLower>().solve(
      contact_force(surface + increment, state.indentation));
  step.array() /= factor_.vectorD().array();
  step = factor_.matrixU().solve(step);
  // Along the step the slope of the potential energy rises from below zero to about zero at its
  // end; where it ends far above, the step went too far. (The energy itself is too coarse a
  // measure: next to a stiff inclusion it is the small difference of large numbers.)
  const double slope = step.dot(balance_of(state));
  State trial = state;
  double share = 1;
  for (int pass = 0; pass < kCutsMax; ++pass) {
    for (int i = 0; i < assembler_.components(); ++i) {
      const int equation = assembler_.equation(i);
      if (equation >= 0) trial.displacement[i] = state.displacement[i] + share * step[equation];
    }
    const bool possible = measure(trial);
    const double end = possible ? step.dot(balance_of(trial)) : 0;
    cut_ = !possible || end > kOvershoot * std::abs(slope);
    if (cut_ && pass + 1 < kCutsMax) {
      share *= possible ? std::clamp(slope / (slope - end), 0.1, 0.7) : 0.5;
      continue;
    }
    if (!possible) return false;
    cut_ = share < 1;
    trial.before = std::move(state.displacement);
    state = std::move(trial);
    return true;
  }
  return false;
}

Eigen::VectorXd FiniteContact::balance_of(const State& state) const {
  Eigen::VectorXd balance = state.residual;
  balance.tail(surface_count()) += contact_force(surface_of(state.displacement), state.indentation);
  return balance;
}

/// S x + contact force(x) = push by Newton's method with a line search on its energy.
bool FiniteContact::settle_contact(const State& state,
                                   const Eigen::VectorXd& push,
                                   Eigen::VectorXd& increment) const {
  const Eigen::VectorXd base = surface_of(state.displacement);
  const Eigen::Index size = surface_count();
  const Eigen::MatrixXd& stiffness = surface_stiffness_;
  const auto energy = [&](const Eigen::VectorXd& x) {
    const Eigen::VectorXd free = x(surface_place_);
    return free.dot(0.5 * (stiffness * free) - push) +
           contact_.measure(base + x, state.indentation).energy;
  };
  double present = energy(increment);
  for (int pass = 0; pass < kContactPassesMax; ++pass) {
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(increment.size(), increment.size());
    Eigen::VectorXd force = Eigen::VectorXd::Zero(increment.size());
    contact_.add(base + increment, state.indentation, tangent, force);
    const Eigen::VectorXd balance =
        stiffness * increment(surface_place_) - push + force(surface_place_);
    Eigen::MatrixXd matrix = stiffness + tangent(surface_place_, surface_place_);
    auto solution = solve_positive(matrix, balance);
    for (double shift = kShift * matrix.diagonal().maxCoeff(); !solution; shift *= 10) {
      if (!std::isfinite(shift)) return false;
      solution = solve_positive(matrix + shift * Eigen::MatrixXd::Identity(size, size), balance);
    }
    const Eigen::VectorXd step = -*solution;
    const double decrement = -step.dot(balance);
    double share = 1;
    Eigen::VectorXd next = increment;
    double reached = present;
    for (int cut = 0; cut < 15; ++cut, share *= 0.5) {
      for (Eigen::Index i = 0; i < size; ++i) {
        const int place = surface_place_[static_cast<std::size_t>(i)];
        next[place] = increment[place] + share * step[i];
      }
      reached = energy(next);
      if (reached <= present - 1e-4 * share * decrement + 1e-13 * std::abs(present)) break;
    }
    increment = next;
    present = reached;
    const double scale = contact_.measure(base + increment, state.indentation).energy;
    if (share < kShareMin || std::abs(decrement) <= kSettled * scale) return true;
  }
  return of_equilibrium_;  // then the outer pass sees what is left
}

Eigen::VectorXd FiniteContact::surface_of(const Eigen::VectorXd& displacement) const {
  Eigen::VectorXd out(2 * static_cast<int>(contact_.nodes().size()));
  for (std::size_t i = 0; i < contact_.nodes().size(); ++i) {
    out.segment<2>(2 * static_cast<int>(i)) = displacement.segment<2>(r_of(contact_.nodes()[i]));
  }
  return out;
}

Eigen::VectorXd FiniteContact::contact_force(const Eigen::VectorXd& surface,
                                             double indentation) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(surface.size());
  contact_.add(surface, indentation, force);
  return force(surface_place_);
}

double FiniteContact::total_energy(const State& state) const {
  return state.elastic + contact_.measure(surface_of(state.displacement), state.indentation).energy;
}

Field FiniteContact::field() const {
  const Eigen::VectorXd& at = solved_.displacement;
  return {at.data(), at.data() + at.size()};
}

double FiniteContact::energy() const { return total_energy(solved_); }

}  // namespace palp::fem
