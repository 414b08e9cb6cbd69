#pragma once

#include <array>
#include <optional>
#include <span>

namespace palp::depth {

/// One point of a force-displacement curve.
struct CurvePoint {
  double indentation{};  ///< [m]
  double force{};        ///< [N]
};

/// Paper eq. (2): f_d = c1 d^3 + c2 d^2 + c3 d + c4 with d in millimetre, as in the paper.
struct Cubic {
  std::array<double, 4> c{};  ///< [N/mm^3], [N/mm^2], [N/mm], [N]
  [[nodiscard]] double force(double indentation) const noexcept;  ///< [m] -> [N]
};

/// The least-squares cubic through `points`, each counted once: evenly spaced points are evenly
/// weighted in d, as in the paper's reference curves. nullopt: they do not determine a cubic.
[[nodiscard]] std::optional<Cubic> fit_cubic(std::span<const CurvePoint> points) noexcept;

}  // namespace palp::depth
