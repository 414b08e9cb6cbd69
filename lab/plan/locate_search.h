#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/core/place.h"
#include "depth/map_estimator.h"
#include "lab/plan/locate_taps.h"

namespace palp::lab {

/// By what the place of the next tap is chosen: what a site proposes; where a Gaussian process
/// hopes for the stiffest tissue; row by row.
enum class TapRule : std::uint8_t { Search, Gp, Raster };
inline constexpr std::array<const char*, 3> kTapRuleNames{"search", "gp", "raster"};

/// A square field of 50 mm, its middle the origin, that is palpated tap by tap. One posterior of
/// one ball judges the touches of every rule, so that the rules differ by their places alone.
inline constexpr double kFieldHalf = 25e-3;      ///< [m]
inline constexpr std::uint32_t kFieldTaps = 49;  ///< of a raster of 8 mm; nobody taps more often

/// What a search came to.
struct Searched {
  std::uint32_t touches{};  ///< in all
  /// After so many x, y and depth were known (one standard deviation of 1 mm) and nothing was
  /// doubted; 0: never.
  std::uint32_t known{};
  /// After so many the place said was within 1 mm of the ball's axis, and stayed there; 0: not at
  /// the end. Of the Gaussian process: its stiffest place.
  std::uint32_t near{};

  /// What is said after the last touch.
  void judge(bool is_known, bool is_near) noexcept;
};

/// Everything of the estimator that a search asks.
struct SearchParts {
  const depth::BallField& field;
  const depth::MapPrior& prior;
  depth::TissuePrior tissue;
  depth::MapEstimatorConfig config;
};

/// Taps until the estimator says that they are enough, kFieldTaps at most. A raster goes on where
/// only no more news is expected, a Gaussian process in any case. `axis`: of the ball; nothing:
/// there is none. `places` is what was touched.
[[nodiscard]] Searched search_field(TapRule rule,
                                    const SearchParts& parts,
                                    Palpation& hand,
                                    const std::optional<Place>& axis,
                                    std::vector<depth::PlaceData>& places);

}  // namespace palp::lab
