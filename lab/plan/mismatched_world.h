#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/place.h"

namespace palp::lab {

/// In what a world differs from what the estimators of depth and place assume.
enum class Mismatch : std::uint8_t {
  Stiffness,    ///< 5 to 10 % from place to place, over 6 to 20 mm
  Relaxing,     ///< lets go of 5 to 30 % of its force within 0.3 to 3 s
  Exponential,  ///< stiffens as an exponential
  Layered,      ///< skin over fat over muscle
  ThinBlock,    ///< 20 to 40 mm high
  TwoBalls,     ///< the second 25 to 40 mm beside
  Breathing,    ///< the surface, by 0.3 to 1.5 mm
  Slope,        ///< the surface, by 5 to 15 degrees
  Dome,         ///< of 40 to 120 mm
  SensorPole    ///< of 6 to 12 Hz, where 20 are said
};
inline constexpr std::array<std::string_view, 10> kMismatchNames{"stiffness",
                                                                 "relaxing",
                                                                 "exponential",
                                                                 "layered",
                                                                 "thin block",
                                                                 "two balls",
                                                                 "breathing",
                                                                 "slope",
                                                                 "dome",
                                                                 "sensor pole"};
[[nodiscard]] constexpr std::string_view to_string(Mismatch kind) noexcept {
  return kMismatchNames[static_cast<std::size_t>(kind)];
}

/// One such world, with the truth about its (first) ball. A value.
struct MismatchedWorld {
  Mismatch kind{};
  bool inclusion{};              ///< else plain
  std::string phantom;           ///< for patient::make_phantom()
  Place axis{};                  ///< of the ball, within `half` to all sides of the middle
  double depth{};                ///< [m]
  double radius{};               ///< [m]
  double ratio{};                ///< [-]
  double breathing_amplitude{};  ///< [m]
  double breathing_frequency{};  ///< [Hz]
  double sensor_pole{20};        ///< [Hz], of the simulated sensor, whatever its facts say
};

/// World `index` of a set: kinds take turns, every third world of a kind is plain (of two balls,
/// none). Ball: 4 to 20 mm deep, radius 4 to 14 mm, ratio 5 to 900, tissue 12 to 18 kPa, all from
/// (seed, index) alone. `half` [m]: how far from the middle its axis may lie.
[[nodiscard]] MismatchedWorld mismatched_world(std::uint64_t seed,
                                               std::uint64_t index,
                                               double half);

}  // namespace palp::lab
