#pragma once

#include <array>

#include "common/core/port_sample.h"

/// The passive contact law that the coupling `mmt` sends instead of delayed forces.
namespace palp::coupling {

/// The four shapes at a scaled depth xi [-] >= 0, in the order of ModelPayload::c.
struct ModelShapes {
  std::array<double, kModelTerms> force{};   ///< [-]
  std::array<double, kModelTerms> energy{};  ///< [-], their integrals from 0
};
[[nodiscard]] ModelShapes model_shapes(double xi) noexcept;

/// A spring without memory: with coefficients >= 0 its force is convex and rising in the depth and
/// 0 at the surface, so that whatever is sent is passive. Deeper than `reach` it goes on along its
/// tangent: what nobody measured is not extrapolated. A value.
struct ContactModel {
  double surface{};                     ///< [m]
  std::array<double, kModelTerms> c{};  ///< [N], each >= 0
  double reach{};                       ///< [m], below the surface

  [[nodiscard]] double force(double depth) const noexcept;   ///< [m] -> [N]
  [[nodiscard]] double energy(double depth) const noexcept;  ///< [m] -> [J], integral of force
  [[nodiscard]] double slope(double depth) const noexcept;   ///< [m] -> [N/m]
};

/// What a receiver may believe: numbers, c >= 0, a surface within `travel` [m] of 0, and no slope
/// above `slope_max` [N/m] down to 5 mm.
[[nodiscard]] bool is_sound(const ModelPayload& model, double travel, double slope_max) noexcept;

/// How far beyond the deepest data a model is trusted [m].
inline constexpr double kModelReachBeyond = 2e-3;
/// Data deeper than this are not believed [m]: the stage does not go there.
inline constexpr double kModelDepthMax = 8e-3;
[[nodiscard]] ContactModel contact_model(const ModelPayload& model) noexcept;

}  // namespace palp::coupling
