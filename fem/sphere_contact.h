#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "fem/mesh.h"
#include "fem/specimen.h"

namespace palp::fem {

/// Frictionless contact of the deformed surface with a rigid sphere, by a penalty at Gauss points
/// of the surface's edges. The penalty is so stiff that the overlap stays below a ten-thousandth of
/// the tip's radius; its bias is below 0.05 % of the force.
class SphereContact {
 public:
  SphereContact(const Mesh& mesh, const Specimen& specimen);

  /// The surface nodes that may touch the sphere. All vectors below hold r and z of each in turn.
  [[nodiscard]] const std::vector<int>& nodes() const noexcept { return nodes_; }

  struct Load {
    double energy{};          ///< [J], of the penalty
    double force{};           ///< [N], on the sphere, upward
    double contact_radius{};  ///< [m], on the undeformed surface
    int touching{};           ///< points in contact
  };
  /// At `indentation` and the nodes' `displacement` [m].
  [[nodiscard]] Load measure(const Eigen::VectorXd& displacement, double indentation) const;
  /// Adds the derivatives of the penalty's energy: `force` [N], `tangent` [N/m].
  void add(const Eigen::VectorXd& displacement,
           double indentation,
           Eigen::MatrixXd& tangent,
           Eigen::VectorXd& force) const;
  void add(const Eigen::VectorXd& displacement, double indentation, Eigen::VectorXd& force) const;

 private:
  struct Point {
    std::array<int, 3> nodes{};     ///< indices into nodes_
    std::array<double, 3> shape{};  ///< [-]
    double r{};                     ///< [m], undeformed
    double area{};                  ///< [m^2], of the undeformed ring
  };
  struct Overlap {
    double depth{};     ///< [m], positive inside the sphere
    double normal_r{};  ///< [-], from the sphere's centre to the point
    double normal_z{};  ///< [-]
    double distance{};  ///< [m], from the centre
  };
  [[nodiscard]] Overlap overlap(const Point& point,
                                const Eigen::VectorXd& displacement,
                                double indentation) const;

  std::vector<int> nodes_;
  std::vector<Point> points_;
  double radius_;   ///< [m]
  double penalty_;  ///< [Pa/m]
};

}  // namespace palp::fem
