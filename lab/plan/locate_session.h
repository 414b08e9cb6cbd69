#pragma once

#include <cstdint>
#include <string>

#include "common/core/place.h"
#include "common/core/result.h"
#include "depth/depth_database.h"
#include "lab/run/scenario.h"

namespace palp::lab {

/// A whole session that palpates for a ball: hand, link, stage and sensor.
struct LocateSession {
  std::string script{"map"};  ///< "map", nine taps, or "search", of surgeon::load_script
  double round_trip{};        ///< [s]
  double loss{};              ///< [-], each way
  double assumed_spread{};    ///< [-], of the tissue's stiffness, by the estimator
  double spread{};            ///< [-], true, over 10 mm
  double scale{1};            ///< [-], of Young's modulus
  std::uint64_t seed{};
};

/// [m], how far from the middle of such taps, along x and y, a ball lies at most: within the nine
/// places, or somewhere in the middle 30 mm of a field of 50 mm.
[[nodiscard]] double reach_of(const std::string& script) noexcept;

/// `ball`: nullptr: plain tissue. `axis`: from the middle of the taps, which is B.
[[nodiscard]] Result<Scenario> locate_scenario(const LocateSession& session,
                                               const depth::DepthDatabase::Query* ball,
                                               const Place& axis);

}  // namespace palp::lab
