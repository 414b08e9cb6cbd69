#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "judge/felt_stiffness.h"
#include "judge/motion.h"
#include "judge/tissue_table.h"

/// The surgeon's side of a stroke: the hand goes into the tissue and out again.
namespace palp::judge {

/// A stroke goes deeper than this past the surface [m]; it is over at half of it.
inline constexpr double kStrokeDepthMin = 1.5e-3;

struct Excursion {
  Place place;
  TimePoint began_at{};
  TimePoint ended_at{};
  std::span<const Motion> loading;  ///< up to the deepest tick
};

/// Excursions deeper than kStrokeDepthMin past `surface` [m], in order of time. Views of `motion`.
[[nodiscard]] std::vector<Excursion> find_excursions(std::span<const Motion> motion,
                                                     double surface);

/// Of an excursion's loading. The truth is that of `tissue` at the same positions; nullptr:
/// unknown.
[[nodiscard]] FeltStiffness stiffness_of(const Excursion& excursion,
                                         double surface,
                                         const TissueTable* tissue);

}  // namespace palp::judge
