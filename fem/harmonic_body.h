#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "fem/assembler.h"
#include "fem/harmonic_element.h"
#include "fem/material.h"
#include "fem/mesh.h"

namespace palp::fem {

/// A body of revolution under forces that are not: small strain, one Fourier harmonic round the
/// axis at a time. Base bonded, side and surface free. What a displacement on the axis may be
/// depends on the harmonic: along z only in order 0, sideways only in order 1, nothing beyond.
/// Owns copies of what it needs of the mesh. Thread: its owner's.
class HarmonicBody {
 public:
  /// `surface`: the nodes that are loaded and looked at.
  HarmonicBody(const Mesh& mesh, const std::vector<int>& surface);

  /// Amplitude of the sinking of surface node i under a unit force on node j at phi = 0: the
  /// sinking at phi is the sum over the orders of it times cos n phi. One factorization. [m/N]
  [[nodiscard]] Eigen::MatrixXd compliance(const std::vector<Material>& materials, int order);

  /// Of order 2 and higher.
  [[nodiscard]] int equations() const noexcept { return layouts_.back().equations; }

 private:
  /// Where a displacement component goes: equation -1: prescribed.
  struct Place {
    int equation{-1};
    double sign{1};  ///< [-]
  };
  /// Orders 0, 1 and all others differ in what the axis may do, so in their equations.
  struct Layout {
    int order{};
    int equations{};
    std::vector<std::array<Place, 3>> places;  ///< of each node: r, z, phi
    std::vector<int> loaded;                   ///< equation of each surface node's z; -1: none
    SparseMatrix pattern;
    std::vector<int> slots;  ///< of the elements' lower triangles in the pattern's values; -1: none
  };

  void order_nodes(const Mesh& mesh);
  [[nodiscard]] Layout lay_out(int order) const;
  void number(Layout& layout) const;
  void lay_pattern(Layout& layout) const;
  [[nodiscard]] static std::array<Place, 27> places_of(const Layout& layout,
                                                       const Element& element);
  [[nodiscard]] SparseMatrix assemble(const Layout& layout,
                                      const std::vector<Material>& materials,
                                      int order) const;

  std::vector<Element> elements_;
  std::vector<ElementGeometry> geometry_;
  std::vector<int> surface_;
  std::vector<bool> base_;   ///< of each node: bonded
  std::vector<bool> axis_;   ///< of each node
  std::vector<int> sorted_;  ///< nodes in the order of elimination, the surface's last
  std::array<Layout, 3> layouts_;
};

}  // namespace palp::fem
