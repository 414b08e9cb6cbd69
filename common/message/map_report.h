#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/core/depth_verdict.h"
#include "common/core/map_doubt.h"
#include "common/core/place.h"
#include "common/core/time.h"
#include "common/message/depth.h"
#include "common/message/enumerators.h"
#include "common/message/field.h"
#include "common/message/limits.h"

/// What touches at several places say together of one round inclusion.
namespace palp {

/// A length as the touches leave it.
struct Located {
  double median{};  ///< [m]
  double low{};     ///< [m], 95 % interval
  double high{};    ///< [m]
  friend bool operator==(const Located&, const Located&) = default;
};

/// The answer, in the patient's file and on its way to the surgeon. Lengths are 0 where nothing was
/// found.
struct MapReport {
  std::uint32_t number{};  ///< of the last stroke in it; 0: none yet
  std::uint32_t places{};  ///< that were touched
  DepthVerdict verdict{};  ///< None or Found
  MapDoubts doubts{};      ///< 0: its numbers may be trusted
  Located x{};             ///< of its axis
  Located y{};
  Located depth{};        ///< of its top
  Located radius{};       ///< of a ball
  double log_odds{};      ///< [-], of a ball somewhere over none
  double place_spread{};  ///< [-], of the tissue's stiffness from place to place, as assumed
  Place next{};           ///< where one more touch tells most
  double next_gain{};     ///< [nat], so much; 0: no place is worth it
  MapStop stop{};

  [[nodiscard]] bool trusted() const noexcept { return doubts == 0; }
  friend bool operator==(const MapReport&, const MapReport&) = default;
};

/// Cells of a stiffness map: so many along x and y at most, and in all.
inline constexpr std::uint32_t kMapSideMax = 13;
inline constexpr std::uint32_t kMapCellsMax = kMapSideMax * kMapSideMax;

/// A cell of the stiffness map of such a report, in the patient's file and on its way to the
/// surgeon, cell by cell.
struct MapCell {
  TimePoint at{};
  std::uint32_t number{};     ///< of the report; 0: none
  std::uint32_t index{};      ///< from 0, row by row from the least y on
  std::uint32_t count{};      ///< of the map's cells
  Place place{};              ///< its middle
  double stiffness{};         ///< [-], over that of the tissue without an inclusion, 2.3 mm deep
  double stiffness_stddev{};  ///< [-], of its logarithm
  double inclusion{};         ///< [-], probability of one below
};

/// The whole of a stiffness map.
struct MapCells {
  std::array<MapCell, kMapCellsMax> all{};
  std::uint32_t count{};  ///< of them are told

  [[nodiscard]] std::span<const MapCell> told() const noexcept {
    return std::span{all}.first(count);
  }
};

/// All that the estimator's thread has found so far.
struct Findings {
  DepthEstimate depth{};  ///< of the newest stroke; number 0: none yet
  MapReport map{};        ///< number 0: touches at too few places
};

namespace message {

template <std::same_as<MapStop> E>
inline constexpr auto enumerators<E> = enumeration("MapStop", "", "GO_ON", "KNOWN", "NO_MORE_NEWS");

template <std::same_as<MapReport> S>
inline constexpr auto fields<S> =
    list({.wire = "Map"},
         field<1, &S::number>("number"),
         field<2, &S::places>("places"),
         field<3, &S::verdict>("verdict"),
         field<4, &S::doubts>("doubts"),
         field<5, &S::stop>("stop"),
         field<6, &S::x, &Located::median>("x_m", wire<float>, limit(kLengthMax)),
         field<7, &S::x, &Located::low>("x_low_m", wire<float>, limit(kLengthMax)),
         field<8, &S::x, &Located::high>("x_high_m", wire<float>, limit(kLengthMax)),
         field<9, &S::y, &Located::median>("y_m", wire<float>, limit(kLengthMax)),
         field<10, &S::y, &Located::low>("y_low_m", wire<float>, limit(kLengthMax)),
         field<11, &S::y, &Located::high>("y_high_m", wire<float>, limit(kLengthMax)),
         field<12, &S::depth, &Located::median>("depth_m", wire<float>, limit(kLengthMax)),
         field<13, &S::depth, &Located::low>("depth_low_m", wire<float>, limit(kLengthMax)),
         field<14, &S::depth, &Located::high>("depth_high_m", wire<float>, limit(kLengthMax)),
         field<15, &S::radius, &Located::median>("radius_m", wire<float>, limit(kLengthMax)),
         field<16, &S::radius, &Located::low>("radius_low_m", wire<float>, limit(kLengthMax)),
         field<17, &S::radius, &Located::high>("radius_high_m", wire<float>, limit(kLengthMax)),
         field<18, &S::log_odds>("log_odds", wire<float>, limit(kForceMax)),
         field<19, &S::place_spread>("place_spread", wire<float>, limit(kLengthMax)),
         field<20, &S::next, &Place::x>("next_x_m", wire<float>, limit(kLengthMax)),
         field<21, &S::next, &Place::y>("next_y_m", wire<float>, limit(kLengthMax)),
         field<22, &S::next_gain>("next_gain", wire<float>, limit(kForceMax)));

template <std::same_as<MapCell> S>
inline constexpr auto fields<S> =
    list({.wire = "MapCell", .log = "MapCell"},
         aside<&S::at>("at_ns"),
         field<1, &S::number>("number"),
         field<2, &S::place, &Place::x>("x_m", wire<float>, limit(kLengthMax)),
         field<3, &S::place, &Place::y>("y_m", wire<float>, limit(kLengthMax)),
         field<4, &S::stiffness>("stiffness", wire<float>, limit(kForceMax)),
         field<5, &S::stiffness_stddev>("stiffness_stddev", wire<float>, limit(kForceMax)),
         field<6, &S::inclusion>("inclusion", wire<float>, limit(1.0)),
         field<7, &S::index>("index", limit(kMapCellsMax - 1)),
         field<8, &S::count>("count", limit(kMapCellsMax)));

}  // namespace message
}  // namespace palp
