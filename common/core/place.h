#pragma once

#include <cmath>

/// Where on the tissue: names and distances. Thread: any.
namespace palp {

/// A place on the undeformed surface, in the plane that the stage travels; its origin lies in the
/// middle of that travel. A value.
struct Place {
  double x{};  ///< [m]
  double y{};  ///< [m]
  friend bool operator==(const Place&, const Place&) = default;
};

/// [m], along the surface. No place is so far that its square overflows: no hypot, which is slow.
[[nodiscard]] inline double distance(const Place& a, const Place& b) noexcept {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  return std::sqrt(x * x + y * y);
}

[[nodiscard]] inline bool is_finite(const Place& place) noexcept {
  return std::isfinite(place.x) && std::isfinite(place.y);
}

/// The place `share` [-] of the way from one to another: at 0 and at 1 exactly the ends.
[[nodiscard]] inline Place between(const Place& from, const Place& to, double share) noexcept {
  return {from.x * (1 - share) + to.x * share, from.y * (1 - share) + to.y * share};
}

/// Farther along the surface is another place: another tissue, for whoever learns one.
inline constexpr double kSamePlace = 1e-3;  ///< [m]

/// Two places have names: A, beside the inclusion of every phantom that is not placed otherwise,
/// and B, above it.
inline constexpr Place kSiteA{};
inline constexpr Place kSiteB{.x = 20e-3, .y = 0};

enum class Site : unsigned char { A, B, Other };

[[nodiscard]] inline Site site_at(const Place& place) noexcept {
  if (distance(place, kSiteA) <= kSamePlace) return Site::A;
  return distance(place, kSiteB) <= kSamePlace ? Site::B : Site::Other;
}

}  // namespace palp
