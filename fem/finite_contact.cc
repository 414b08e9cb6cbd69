#include "fem/finite_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <Eigen/Cholesky>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

constexpr double kStepMax = 0.05;      // [radii]: 0.25 mm for the paper's tip
constexpr double kStepMin = 1e-4;      // [radii]
constexpr int kPassesMax = 12;         // of one step; 2 to 4 are usual
constexpr int kContactPassesMax = 60;  // on the dense surface; about 10 are usual
constexpr double kTolerance = 1e-5;    // of the residual, relative to the contact's force
constexpr double kSlow = 0.3;          // of the residual before: new factors are worth it
constexpr double kNear = 0.05;         // residual from which the guess's own tangent is sound
constexpr double kShift = 1e-6;        // of the surface's tangent where it is indefinite
constexpr double kSettled = 1e-12;     // of the penalty's energy: the contact has settled
constexpr double kShareMin = 1e-4;     // of a contact step: rounding is all that is left
constexpr double kEnergyJump = 10;     // a step that raises the energy so much went astray
constexpr std::size_t kHistory = 3;    // states behind a prediction

}  // namespace

FiniteContact::FiniteContact(const Mesh& mesh, const Specimen& specimen)
    : contact_{mesh, specimen},
      assembler_{mesh, materials_of(specimen), bonded_base(mesh), contact_.nodes()},
      tangent_{assembler_.pattern()},
      residual_(assembler_.equations()),
      solved_{State{0, Eigen::VectorXd::Zero(assembler_.components())}},
      step_max_{kStepMax * specimen.indenter.radius},
      step_{0.4 * step_max_} {
  PALP_CHECK(specimen.indenter.shape == IndenterShape::Sphere, "model N knows the sphere");
  factor_.analyzePattern(tangent_);
  for (std::size_t i = 0; i < contact_.nodes().size(); ++i) {
    for (const int axis : {0, 1}) {
      if (assembler_.equation(r_of(contact_.nodes()[i]) + axis) < 0) continue;
      surface_place_.push_back(2 * static_cast<int>(i) + axis);
    }
  }
}

Result<CurveRow> FiniteContact::press(double indentation) {
  const double step_min = step_max_ * kStepMin / kStepMax;
  while (solved_.back().indentation < indentation) {
    const double left = indentation - solved_.back().indentation;
    // Equal steps up to the next row that was asked for.
    const double step = left / std::ceil(left / step_ - 1e-9);
    const bool last = step > left * (1 - 1e-9);
    State next = predict(last ? indentation : solved_.back().indentation + step);
    if (solve(next)) {
      solved_.push_back(std::move(next));
      if (solved_.size() > kHistory) solved_.erase(solved_.begin());
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
                    solved_.back().indentation / kMillimetre,
                    indentation / kMillimetre);
      return fail(text);
    }
  }
  const SphereContact::Load load =
      contact_.measure(surface_of(solved_.back().displacement), indentation);
  return CurveRow{.indentation = indentation,
                  .force = load.force,
                  .contact_radius = load.contact_radius,
                  .error = 0};
}

/// Polynomial through the last states (Lagrange).
FiniteContact::State FiniteContact::predict(double indentation) const {
  State guess{indentation, Eigen::VectorXd::Zero(assembler_.components())};
  // The first steps start from the undeformed state, where the contact is a point: no polynomial.
  const std::size_t from = solved_.size() > 2 && solved_[0].indentation == 0 ? 1 : 0;
  for (std::size_t i = from; i < solved_.size(); ++i) {
    double weight = 1;
    for (std::size_t j = from; j < solved_.size(); ++j) {
      if (j == i) continue;
      weight *= (indentation - solved_[j].indentation) /
                (solved_[i].indentation - solved_[j].indentation);
    }
    guess.displacement += weight * solved_[i].displacement;
  }
  return guess;
}

bool FiniteContact::solve(State& state) {
  residuals_.clear();
  if (!std::isfinite(assembler_.energy(state.displacement))) {
    state.displacement = solved_.back().displacement;
  }
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kPassesMax; ++pass) {
    Eigen::VectorXd force;
    const Assembler::Result elastic = assembler_.balance(state.displacement, force);
    if (!(elastic.volume_ratio_min > 0)) return false;
    for (int i = 0; i < assembler_.components(); ++i) {
      if (assembler_.equation(i) >= 0) residual_[assembler_.equation(i)] = force[i];
    }
    const Eigen::VectorXd surface = surface_of(state.displacement);
    Eigen::VectorXd balance = residual_;
    add_contact(surface, state.indentation, balance);
    const SphereContact::Load load = contact_.measure(surface, state.indentation);
    residuals_.push_back(balance.norm() / std::max(load.force, 1e-300));
    if (!std::isfinite(residuals_.back())) return false;
    if (load.touching > 0 && residuals_.back() < kTolerance) return true;
    if (!choose_factors(state, before)) return false;
    before = residuals_.back();
    if (!improve(state, elastic.energy + load.energy)) return false;
  }
  return false;
}

/// Factors serve as long as they bring the residual down fast. Far from equilibrium those of the
/// last equilibrium are better than those of the guess, whose stresses are its own: a stiff
/// inclusion, bent a little by the prediction, would make the tangent indefinite.
bool FiniteContact::choose_factors(const State& state, double before) {
  const double now = residuals_.back();
  const bool slow = now > kSlow * before;
  const State& last = solved_.back();
  if (factorizations_ > 0 && !slow) return true;
  if (now < kNear && residuals_.size() > 1) return factorize(state);
  return factorized_at_ == last.indentation && factorizations_ > 0 ? true : factorize(last);
}

bool FiniteContact::factorize(const State& state) {
  factorized_at_ = state.indentation;
  Eigen::VectorXd force;
  assembler_.assemble(Strain::Finite, state.displacement, tangent_, force);
  factor_.factorize(tangent_);
  ++factorizations_;
  return factor_.info() == Eigen::Success;
}

bool FiniteContact::improve(State& state, double energy_before) {
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(2 * static_cast<int>(contact_.nodes().size()));
  if (!settle_contact(state, increment)) return false;
  Eigen::VectorXd right = residual_;
  add_contact(surface_of(state.displacement) + increment, state.indentation, right);
  const Eigen::VectorXd step = factor_.solve(-right);
  // Shorter only where the full step would turn an element inside out.
  State trial = state;
  double share = 1;
  const double limit =
      solved_.size() > 1 ? kEnergyJump * energy_before : std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 5; ++pass, share *= 0.5) {
    for (int i = 0; i < assembler_.components(); ++i) {
      const int equation = assembler_.equation(i);
      if (equation >= 0) trial.displacement[i] = state.displacement[i] + share * step[equation];
    }
    const double energy = total_energy(trial);
    if (!std::isfinite(energy) || energy > limit) continue;
    state = std::move(trial);
    return true;
  }
  return false;
}

/// S x + contact force(x) = b by Newton's method with a line search on its energy: S is the block's
/// stiffness condensed to the surface, b what the inside adds to the surface's own residual.
bool FiniteContact::settle_contact(const State& state, Eigen::VectorXd& increment) const {
  const Eigen::VectorXd base = surface_of(state.displacement);
  const auto size = static_cast<Eigen::Index>(surface_place_.size());
  const Eigen::MatrixXd lower = surface_factor();
  const Eigen::MatrixXd stiffness =
      lower * factor_.vectorD().tail(size).asDiagonal() * lower.transpose();
  const Eigen::VectorXd push = lower * factor_.matrixL().solve(-residual_).tail(size);
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
    Eigen::LLT<Eigen::MatrixXd> factor{matrix};
    for (double shift = kShift * matrix.diagonal().maxCoeff(); factor.info() != Eigen::Success;
         shift *= 10) {
      if (!std::isfinite(shift)) return false;
      factor.compute(matrix + shift * Eigen::MatrixXd::Identity(size, size));
    }
    const Eigen::VectorXd step = -factor.solve(balance);
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
  return true;  // the outer pass sees what is left
}

Eigen::MatrixXd FiniteContact::surface_factor() const {
  const auto size = static_cast<int>(surface_place_.size());
  const int first = assembler_.equations() - size;
  Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(size, size);
  const SparseMatrix& factors = factor_.matrixL().nestedExpression();
  for (int column = 0; column < size; ++column) {
    for (SparseMatrix::InnerIterator it{factors, first + column}; it; ++it) {
      if (it.row() > it.col()) lower(it.row() - first, column) = it.value();
    }
  }
  return lower;
}

Eigen::VectorXd FiniteContact::surface_of(const Eigen::VectorXd& displacement) const {
  Eigen::VectorXd out(2 * static_cast<int>(contact_.nodes().size()));
  for (std::size_t i = 0; i < contact_.nodes().size(); ++i) {
    out.segment<2>(2 * static_cast<int>(i)) = displacement.segment<2>(r_of(contact_.nodes()[i]));
  }
  return out;
}

void FiniteContact::add_contact(const Eigen::VectorXd& surface,
                                double indentation,
                                Eigen::VectorXd& to) const {
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(surface.size(), surface.size());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(surface.size());
  contact_.add(surface, indentation, tangent, force);
  const int first = assembler_.equations() - static_cast<int>(surface_place_.size());
  for (std::size_t i = 0; i < surface_place_.size(); ++i) {
    to[first + static_cast<int>(i)] += force[surface_place_[i]];
  }
}

double FiniteContact::total_energy(const State& state) const {
  const double elastic = assembler_.energy(state.displacement);
  if (!std::isfinite(elastic)) return elastic;
  return elastic + contact_.measure(surface_of(state.displacement), state.indentation).energy;
}

Field FiniteContact::field() const {
  const Eigen::VectorXd& at = solved_.back().displacement;
  return {at.data(), at.data() + at.size()};
}

double FiniteContact::energy() const { return total_energy(solved_.back()); }

}  // namespace palp::fem
