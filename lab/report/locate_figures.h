#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "lab/plan/locate_study.h"

/// What the cases of a study of maps come to, for its reports. Pure.
namespace palp::lab {

/// Of balls that were found.
struct LocateFigures {
  std::size_t count{};
  std::size_t found{};
  std::size_t trusted{};
  std::array<std::size_t, kLocated> inside{};
  std::array<double, kLocated> rmse{};    ///< [as the coordinate]
  std::array<double, kLocated> bounds{};  ///< [as the coordinate], root mean square; 0: none
};

/// A name and the cases of it.
struct LocateRow {
  std::string name;
  LocateFigures figures;
};

/// A third of the radii and of the depths that are drawn.
struct LocateCell {
  std::string name;
  std::array<double, 2> radius{};  ///< [m]
  std::array<double, 2> depth{};   ///< [m]
  LocateFigures figures;
};

[[nodiscard]] LocateFigures figures_of_all(const std::vector<LocateCase>& cases);
[[nodiscard]] std::vector<LocateCell> cells_of(const LocateStudy& study,
                                               const std::vector<LocateCase>& cases);
/// Hard balls near the surface, anywhere and below the middle place; thirds of the ratio.
[[nodiscard]] std::vector<LocateRow> rows_of(const LocateStudy& study,
                                             const std::vector<LocateCase>& cases);

struct LocateAlarms {
  std::size_t plain{};
  std::size_t found{};    ///< of those
  std::size_t doubted{};  ///< of all, for any reason
  std::size_t model{};    ///< of all, because the tissue is not as assumed
  std::size_t all{};
};
[[nodiscard]] LocateAlarms alarms(const std::vector<LocateCase>& cases);

/// Of the worlds of a kind, or of all.
struct LocateWorlds {
  std::string name;
  std::size_t count{};
  std::size_t wrong{};  ///< confidently
  std::size_t warned{};
  std::size_t alarms{};  ///< plain ones in which something was found, doubted or not
};
[[nodiscard]] std::vector<LocateWorlds> worlds_of(const std::vector<LocateCase>& cases);

[[nodiscard]] std::size_t right_of(const std::vector<LocateCase>& cases);
[[nodiscard]] std::size_t balls_of(const std::vector<LocateCase>& cases);

/// Median number of strokes of the sessions that found their ball; 0: there are none.
[[nodiscard]] double strokes_of(const std::vector<LocateCase>& cases);

/// Of a number of touches, 0 of them for never, over all balls: the value that `share` [-] of them
/// do not exceed, of an even number the mean of both; 0: never for so many.
[[nodiscard]] double touches_of(const std::vector<LocateCase>& cases,
                                std::uint32_t Searched::*number,
                                double share = 0.5);

/// [m] or [-]: a coordinate is told in so much.
[[nodiscard]] double unit_of(std::size_t coordinate);
[[nodiscard]] double share_or_zero(std::size_t part, std::size_t whole);

/// Sessions do not tell a ratio.
[[nodiscard]] bool tells(const LocateStudy& study, std::size_t coordinate);

}  // namespace palp::lab
