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
/// Newton's method along the indentation. Each pass factorizes the elastic tangent alone, with the
/// nodes that may touch the sphere last: the trailing block of the factors is then the block's
/// stiffness as its surface feels it, and the contact, whose status flips from pass to pass, is
/// settled on that small dense system. What is left for the outer passes is smooth: two or three,
/// from a polynomial through the states before.
/// Owns its mesh's system. Thread: its owner's.
class FiniteContact {
 public:
  FiniteContact(const Mesh& mesh, const Specimen& specimen);

  /// Goes on from the last indentation to this one, which is not smaller. [m]
  [[nodiscard]] Result<CurveRow> press(double indentation);

  /// At the last indentation.
  [[nodiscard]] Field field() const;
  [[nodiscard]] double energy() const;  ///< [J], elastic and penalty
  [[nodiscard]] int equations() const noexcept { return assembler_.equations(); }
  /// Newton passes so far: one factorization each.
  [[nodiscard]] int factorizations() const noexcept { return factorizations_; }
  /// Residuals over the contact's force, of the last step's passes.
  [[nodiscard]] const std::vector<double>& residuals() const noexcept { return residuals_; }

 private:
  using Factor = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;

  struct State {
    double indentation{};          ///< [m]
    Eigen::VectorXd displacement;  ///< [m], all components
  };
  [[nodiscard]] State predict(double indentation) const;
  /// True if `state`, which holds a first guess, now solves its indentation.
  [[nodiscard]] bool solve(State& state);
  [[nodiscard]] bool choose_factors(const State& state, double before);
  [[nodiscard]] bool factorize(const State& state);
  /// By the present factors; false if the state cannot be improved.
  [[nodiscard]] bool improve(State& state, double energy_before);
  /// Displacement increment of the contact nodes: block's surface stiffness against the sphere.
  [[nodiscard]] bool settle_contact(const State& state, Eigen::VectorXd& increment) const;
  /// The trailing block of the factor L: the contact's equations.
  [[nodiscard]] Eigen::MatrixXd surface_factor() const;
  [[nodiscard]] Eigen::VectorXd surface_of(const Eigen::VectorXd& displacement) const;
  /// Contact forces as a right-hand side, and to all equations. [N]
  void add_contact(const Eigen::VectorXd& surface, double indentation, Eigen::VectorXd& to) const;
  [[nodiscard]] double total_energy(const State& state) const;

  SphereContact contact_;
  Assembler assembler_;
  SparseMatrix tangent_;
  Factor factor_;
  Eigen::VectorXd residual_;        ///< [N], elastic, all equations
  std::vector<int> surface_place_;  ///< of the contact's free components, in equation order
  std::vector<State> solved_;       ///< the last ones, oldest first
  double step_max_;                 ///< [m], of the indentation
  double step_;                     ///< [m], that worked last
  int factorizations_{};
  double factorized_at_{};         ///< [m], indentation of the present factors
  std::vector<double> residuals_;  ///< [-]
};

}  // namespace palp::fem
