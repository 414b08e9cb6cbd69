#pragma once

#include <cstdint>

namespace palp::judge {

/// The two sites that runs compare: A is plain tissue, B lies over the inclusion.
enum class Site : std::uint8_t { A, B };
inline constexpr double kSiteBoundary = 5e-3;  ///< [m], lateral; below it lies A

[[nodiscard]] constexpr Site site_at(double lateral) noexcept {
  return lateral < kSiteBoundary ? Site::A : Site::B;
}
[[nodiscard]] constexpr const char* to_string(Site site) noexcept {
  return site == Site::A ? "A" : "B";
}

}  // namespace palp::judge
