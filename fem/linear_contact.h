#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/core/result.h"
#include "fem/assembler.h"
#include "fem/curve.h"
#include "fem/specimen.h"

namespace palp::fem {

/// Model L1: small strain, linearised Signorini contact. The block's stiffness is condensed to the
/// surface nodes that can come into contact (one factorization, one solve per node); then every
/// indentation is a small dense complementarity problem, solved exactly:
///   u_z(r) <= -(d - profile(r)),  pressure >= 0, vertical, on the undeformed surface.
/// Owns its mesh's system. Thread: its owner's.
class LinearContact {
 public:
  /// Prepared for indentations up to `indentation_max` [m].
  LinearContact(const Mesh& mesh, const Specimen& specimen, double indentation_max);

  /// In any order; 0 <= indentation <= indentation_max. [m]
  [[nodiscard]] Result<CurveRow> press(double indentation);

  /// Of the last press().
  [[nodiscard]] Field field() const;
  /// Elastic energy of the last press(). [J]
  [[nodiscard]] double energy() const;
  /// Displacement of contact node i under a unit force on node j. [m/N]
  [[nodiscard]] const Eigen::MatrixXd& compliance() const noexcept { return compliance_; }
  /// Of the compliance as it came out of the factors, relative; compliance() is symmetric by force.
  [[nodiscard]] double asymmetry() const noexcept { return asymmetry_; }
  [[nodiscard]] int equations() const noexcept { return assembler_.equations(); }

 private:
  struct ContactNode {
    int node{};
    double r{};        ///< [m]
    double profile{};  ///< [m], of the indenter above its lowest point
  };

  void collect_nodes(const Mesh& mesh, const Specimen& specimen, double indentation_max);
  /// Forces on the active nodes, or false if the block is not solvable.
  [[nodiscard]] bool solve_active(double indentation);
  /// One pass of the active set; true if it changed.
  [[nodiscard]] bool update_active(double indentation);
  [[nodiscard]] double contact_radius(double indentation) const;

  Assembler assembler_;
  std::vector<ContactNode> contact_;
  Eigen::MatrixXd response_;    ///< [m/N], all equations, one column per contact node
  Eigen::MatrixXd compliance_;  ///< [m/N], downward, between contact nodes
  double asymmetry_{};          ///< [-]
  std::vector<bool> active_;
  Eigen::VectorXd force_;  ///< [N], downward, on contact nodes
};

/// The block's and the inclusion's materials, in that order.
[[nodiscard]] std::vector<Material> materials_of(const Specimen& specimen);

}  // namespace palp::fem
