#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "fem/element.h"
#include "fem/material.h"
#include "fem/mesh.h"

namespace palp::fem {

/// Lower triangle.
using SparseMatrix = Eigen::SparseMatrix<double>;

/// A displacement component: 2 * node for r, 2 * node + 1 for z.
[[nodiscard]] constexpr int r_of(int node) noexcept { return 2 * node; }
[[nodiscard]] constexpr int z_of(int node) noexcept { return 2 * node + 1; }

/// Numbers the free displacement components of a mesh, keeps the sparsity pattern and adds element
/// contributions into it. Displacement vectors are full (two per node, prescribed ones included);
/// equations are the free components only. Owns copies of what it needs of the mesh.
class Assembler {
 public:
  /// `fixed[component]`: prescribed. A component that no element touches is fixed as well. The free
  /// components of the nodes `last` become the last equations, in that order; all others are
  /// numbered for little fill (approximate minimum degree): factorize in this order.
  Assembler(const Mesh& mesh,
            const std::vector<Material>& materials,
            const std::vector<bool>& fixed,
            const std::vector<int>& last = {});

  [[nodiscard]] int equations() const noexcept { return equations_; }
  [[nodiscard]] int components() const noexcept { return static_cast<int>(equation_.size()); }
  /// -1: prescribed.
  [[nodiscard]] int equation(int component) const noexcept {
    return equation_[static_cast<std::size_t>(component)];
  }

  struct Result {
    double energy{};             ///< [J]
    double volume_ratio_min{1};  ///< [-], not positive: the state is impossible
  };
  /// Energy, its derivative (all components) and its second derivative (free ones) at
  /// `displacement`.
  Result assemble(Strain strain,
                  const Eigen::VectorXd& displacement,
                  SparseMatrix& tangent,
                  Eigen::VectorXd& force) const;
  /// Finite strain, with a tangent of independent pressures, one per element (see element.h).
  Result assemble(const Eigen::VectorXd& displacement,
                  const std::vector<Pressure>& pressures,
                  SparseMatrix& tangent,
                  Eigen::VectorXd& force) const;
  /// The pressures after a step, to first order.
  [[nodiscard]] std::vector<Pressure> pressures_after(const Eigen::VectorXd& displacement,
                                                      const Eigen::VectorXd& step) const;
  /// Energy and its first derivative alone, finite strain.
  Result balance(const Eigen::VectorXd& displacement, Eigen::VectorXd& force) const;
  /// Energy alone; infinite where the state is impossible. [J]
  [[nodiscard]] double energy(const Eigen::VectorXd& displacement) const;

  /// A matrix with the pattern, all zero.
  [[nodiscard]] SparseMatrix pattern() const { return pattern_; }
  [[nodiscard]] const std::vector<ElementGeometry>& geometry() const noexcept { return geometry_; }

 private:
  [[nodiscard]] ElementVector gather(std::size_t element, const Eigen::VectorXd& from) const;
  template <typename Respond>
  Result add_up(const Respond& respond_of, SparseMatrix& tangent, Eigen::VectorXd& force) const;
  void number(const std::vector<bool>& free, const std::vector<int>& last);
  [[nodiscard]] SparseMatrix with_clique(const std::vector<int>& last) const;
  void lay_pattern();
  void lay_places();

  std::vector<std::array<int, 18>> components_;  ///< of each element: r of nine nodes, then z
  std::vector<Material> material_;               ///< of each element
  std::vector<ElementGeometry> geometry_;
  std::vector<int> equation_;
  int equations_{};
  SparseMatrix pattern_;
  std::vector<std::array<int, 171>> places_;  ///< of an element's lower triangle, in the values
};

/// What an indented block prescribes: axis, bonded base.
[[nodiscard]] std::vector<bool> bonded_base(const Mesh& mesh);

}  // namespace palp::fem
