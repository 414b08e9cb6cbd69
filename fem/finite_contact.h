#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include "common/core/result.h"
#include "fem/assembler.h"
#include "fem/curve.h"
#include "fem/specimen.h"
#include "fem/sphere_contact.h"

namespace palp::fem {

/// Model N: compressible neo-Hookean, finite strain, contact of the deformed surface with the true
/// sphere.
///
/// Newton's method along the indentation, from the last state: polynomials through the states
/// before are no better, because the contact's edge moves. The elements' pressures are unknowns of
/// their own (see element.h). Each pass uses factors of the elastic tangent alone, with the nodes
/// that may touch the sphere last: the trailing block of the factors is then the block's stiffness
/// as its surface feels it, and the contact, whose status flips from pass to pass, is settled on
/// that small dense system. What is left for the outer passes is smooth: one factorization and six
/// passes a step are usual. Owns its mesh's system. Thread: its owner's.
class FiniteContact {
 public:
  FiniteContact(const Mesh& mesh, const Specimen& specimen);

  /// Goes on from the last indentation to this one, which is not smaller. [m]
  [[nodiscard]] Result<CurveRow> press(double indentation);

  /// At the last indentation.
  [[nodiscard]] Field field() const;
  [[nodiscard]] double energy() const;  ///< [J], elastic and penalty
  [[nodiscard]] int equations() const noexcept { return assembler_.equations(); }
  /// So far.
  [[nodiscard]] int factorizations() const noexcept { return factorizations_; }
  /// Residuals over the contact's force, of the last step's passes.
  [[nodiscard]] const std::vector<double>& residuals() const noexcept { return residuals_; }

 private:
  using Factor = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;

  struct State {
    double indentation{};          ///< [m]
    Eigen::VectorXd displacement;  ///< [m], all components
    Eigen::VectorXd residual;      ///< [N], elastic, all equations; empty: not known
    double elastic{};              ///< [J]
    Eigen::VectorXd before;        ///< [m], displacement a pass ago
  };
  /// Fills in residual and elastic energy; false where the state is impossible.
  [[nodiscard]] bool measure(State& state) const;
  /// True if `state`, which holds a first guess, now solves its indentation.
  [[nodiscard]] bool solve(State& state);
  [[nodiscard]] bool stuck() const;
  [[nodiscard]] bool choose_factors(const State& state);
  [[nodiscard]] bool factorize(const State& state);
  /// By the present factors; false if the state cannot be improved.
  [[nodiscard]] bool improve(State& state);
  /// Displacement increment of the contact nodes: block's surface stiffness against the sphere.
  /// `push`: what the inside's residual adds to the surface's own. [N]
  [[nodiscard]] bool settle_contact(const State& state,
                                    const Eigen::VectorXd& push,
                                    Eigen::VectorXd& increment) const;
  /// Takes the contact's trailing block out of the factors.
  void condense();
  [[nodiscard]] Eigen::VectorXd surface_of(const Eigen::VectorXd& displacement) const;
  /// On the contact's equations. [N]
  [[nodiscard]] Eigen::VectorXd contact_force(const Eigen::VectorXd& surface,
                                              double indentation) const;
  /// Elastic and contact, all equations. [N]
  [[nodiscard]] Eigen::VectorXd balance_of(const State& state) const;
  [[nodiscard]] double total_energy(const State& state) const;  ///< [J]
  [[nodiscard]] int surface_count() const noexcept {
    return static_cast<int>(surface_place_.size());
  }

  SphereContact contact_;
  Assembler assembler_;
  SparseMatrix tangent_;
  Factor factor_;
  Eigen::MatrixXd surface_lower_;      ///< [-], trailing block of L
  Eigen::MatrixXd surface_stiffness_;  ///< [N/m], of the block as its surface feels it
  std::vector<int> surface_place_;     ///< of the contact's free components, in equation order
  State solved_;                       ///< at the last indentation
  double step_max_;                    ///< [m], of the indentation
  double step_;                        ///< [m], that worked last
  int factorizations_{};
  bool of_equilibrium_{};          ///< the factors are, not of a guess
  bool cut_{};                     ///< the last pass's step was shortened
  std::vector<double> residuals_;  ///< [-]
};

}  // namespace palp::fem
