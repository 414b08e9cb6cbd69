#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "depth/contact_curve.h"

namespace palp::depth {

/// A smooth law of contact: F = sum of c_j xi^(1.5 + j/2), j = 0..4, xi = indentation in mm. A
/// round tip begins like Hertz (xi^1.5); what lies below the surface shows in the higher powers.
struct ContactLaw {
  double surface{};           ///< [m], where contact begins
  std::array<double, 5> c{};  ///< [N]
  double rate_factor{};       ///< [s/m]: the force is F (1 + factor * rate)
  [[nodiscard]] double force(double indentation) const noexcept;  ///< [m] -> [N], at rest
};

struct SurfaceConfig {
  /// [N], force at 1 mm of a round tip on the block alone by Hertz' law, 4/3 E/(1 - nu^2) sqrt(R)
  /// (1 mm)^1.5 with the paper's E = 15.3 kPa, nu = 0.49 and R = 5 mm. Eq. (3) of the paper holds
  /// for this tissue only; other tissue is recognised and fitted without it.
  double hertz_force{0.06003};
  double indentation_max{4.05e-3};  ///< [m], deepest data used: eq. (2) is fitted over 0 to 4 mm
  double search_out{2.4e-3};        ///< [m], how far before the first felt contact to look
  double search_in{0.1e-3};         ///< [m], and behind it
  double step{50e-6};               ///< [m], of the first search
};

struct SurfaceInput {
  std::span<const ContactPoint> points;
  double first_contact{};           ///< [m], where the force was first felt
  double noise{};                   ///< [N], rms of one sample
  double rate_factor{};             ///< [s/m], as known so far
  std::optional<double> surface{};  ///< [m], as known so far: search near it first
};

/// Finds the surface and the law together: the surface hides in the transducer's noise and steps
/// for the first 0.4 mm, and 0.05 mm of it are 7 % of the paper's h, so it is a parameter of the
/// fit. For every candidate surface the law is linear in its coefficients: penalised least squares,
/// the air in front included. The penalty holds the coefficients near those of a round tip on
/// tissue as far as the noise leaves them open; data without noise overrule it.
/// nullopt: the points show no contact, or none that begins where it was looked for.
[[nodiscard]] std::optional<ContactLaw> find_surface(const SurfaceInput& input,
                                                     const SurfaceConfig& config);

}  // namespace palp::depth
