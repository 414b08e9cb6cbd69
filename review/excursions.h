#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "review/site_data.h"
#include "review/tissue_table.h"

/// The surgeon's side of a stroke: the hand goes into the tissue and out again.
namespace palp::review {

/// Positions past the surface [m] between which a stiffness is fitted: below, contact is still
/// being found; above, the hand turns back. Fewer ticks than that say nothing.
inline constexpr double kFitBegin = 1.2e-3;
inline constexpr double kFitEnd = 3.6e-3;
inline constexpr std::size_t kFitTicksMin = 21;
/// A stroke goes deeper than this past the surface [m]; it is over at half of it.
inline constexpr double kStrokeDepthMin = 1.5e-3;

struct Excursion {
  Place place{};
  TimePoint began_at{};
  TimePoint ended_at{};
  std::span<const Motion> loading;  ///< up to the deepest tick
};

/// Excursions deeper than kStrokeDepthMin past `surface` [m], in order of time. Views of `motion`.
[[nodiscard]] std::vector<Excursion> find_excursions(std::span<const Motion> motion,
                                                     double surface);

struct Stiffness {
  std::optional<double> felt;   ///< [N/m]
  std::optional<double> truth;  ///< [N/m], of the static tissue law at the same positions
};

/// Least-squares slopes (with intercept) over the loading ticks that move inwards between
/// kFitBegin and kFitEnd.
[[nodiscard]] Stiffness fit_stiffness(const Excursion& excursion,
                                      double surface,
                                      const TissueTable* tissue);

}  // namespace palp::review
