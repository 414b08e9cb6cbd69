#pragma once

#include <string>
#include <vector>

namespace palp::fem {

/// One law of mechanics or of approximation the solver must keep, and how well it does.
struct Check {
  std::string law;       ///< with its parameters
  std::string quantity;  ///< what is compared, with its unit if it has one
  double found{};        ///< [as the quantity]
  double wanted{};       ///< [as the quantity]
  double tolerance{};    ///< [as the quantity], of the difference
  [[nodiscard]] bool passed() const noexcept;
};
using Checks = std::vector<Check>;

/// Quick: coarser meshes and fewer parameters, for the unit tests; the same laws and tolerances.
enum class Extent { Quick, Full };

/// Elements and linear elasticity against closed solutions: patch test, free motions, a made-up
/// field, thick-walled cylinder and sphere, a sphere in a matrix, a cavity.
[[nodiscard]] Checks elastic_checks(Extent extent);
/// Finite strain: homogeneous states, the tangent, a cavity that is inflated, Newton's rate.
[[nodiscard]] Checks finite_checks(Extent extent);
/// Contact: Hertz, Sneddon, punch, cone, bonded layer; energy and symmetry of both models.
[[nodiscard]] Checks contact_checks(Extent extent);

/// All of them, in that order.
[[nodiscard]] Checks verification(Extent extent);

/// Relative: `found` over `wanted` within `share`.
[[nodiscard]] Check close(
    const std::string& law, const std::string& quantity, double found, double wanted, double share);
/// Slope of log(error) over log(size) between two meshes whose sizes differ by `factor`, within
/// 0.15 of `wanted`.
[[nodiscard]] Check order(const std::string& law,
                          const std::string& quantity,
                          double coarse_error,
                          double fine_error,
                          double factor,
                          double wanted);

}  // namespace palp::fem
