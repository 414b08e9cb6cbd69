#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "fem/assembler.h"
#include "fem/element.h"
#include "fem/material.h"
#include "fem/mesh.h"

/// Bodies that textbooks solve: a ring-shaped body mapped from a square, with supports and loads.
/// What the verification needs beside the indented block.
namespace palp::fem {

struct Vector2 {
  double r{};  ///< [as the field]
  double z{};  ///< [as the field]
};
/// A vector at a place: a displacement [m], a traction [Pa] or a body force [N/m^3].
using VectorField = std::function<Vector2(const Node& place)>;

/// Where a body lies in the square [0, 1]^2: s along the columns, t along the rows.
using Placement = std::function<Node(double s, double t)>;

enum class Side { SLow, SHigh, TLow, THigh };

/// A lattice of columns x rows elements, its supports and its loads. Owns its mesh.
class MappedBody {
 public:
  MappedBody(int columns, int rows, const Placement& place, Material material);

  [[nodiscard]] const Mesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const Material& material() const noexcept { return material_; }
  /// Elements whose middle lies where `inside` says so are of the other material.
  void embed(const Material& other, const std::function<bool(const Node&)>& inside);

  /// Nodes of a side, in order.
  [[nodiscard]] std::vector<int> nodes_of(Side side) const;
  void support_r(Side side, const VectorField& displacement);
  void support_z(Side side, const VectorField& displacement);
  void support(Side side, const VectorField& displacement);
  /// Dead traction: per undeformed area, whatever the body does.
  void pull(Side side, const VectorField& traction);
  void fill(const VectorField& body_force);

  struct Solution {
    Eigen::VectorXd displacement;   ///< [m], all components
    Eigen::VectorXd reaction;       ///< [N], what the supports give, all components
    std::vector<double> residuals;  ///< [N], of Newton's passes
    bool solved{};
  };
  [[nodiscard]] Solution solve(Strain strain) const;

  /// Of `found` against an exact field.
  struct Error {
    double l2{};  ///< [-], of the displacement, relative
    double h1{};  ///< [-], of its gradient, relative
  };
  /// `gradient`: F - 1 of the exact field.
  [[nodiscard]] Error error_of(const Eigen::VectorXd& found,
                               const VectorField& exact,
                               const std::function<Gradient(const Node&)>& gradient) const;

  /// F at a node, the mean over the elements that share it.
  [[nodiscard]] Gradient gradient_at(const Eigen::VectorXd& displacement, int node) const;

 private:
  struct Sample {
    Node place;        ///< [m]
    Vector2 moved;     ///< [m]
    Gradient f{};      ///< [-]
    Shape shape;       ///< [-]
    double measure{};  ///< [m^2], of the square's unit area in the section
  };
  [[nodiscard]] Sample sample(const Element& element,
                              const Eigen::VectorXd& displacement,
                              double xi,
                              double eta) const;
  void support_component(Side side, int axis, const VectorField& displacement);

  int columns_;
  int rows_;
  Mesh mesh_;
  Material material_;
  Material other_;
  std::vector<bool> fixed_;
  Eigen::VectorXd prescribed_;  ///< [m]
  Eigen::VectorXd load_;        ///< [N]
};

}  // namespace palp::fem
