#pragma once

#include <cstdint>
#include <string>

#include "common/core/place.h"
#include "common/core/result.h"
#include "depth/depth_database.h"
#include "lab/run/scenario.h"

namespace palp::lab {

inline constexpr double kDatabaseModulus = fem::Block{}.youngs_modulus;  ///< [Pa], Young's

/// A whole session that palpates for a ball: hand, link, stage and sensor.
struct LocateSession {
  std::string script{"map"};         ///< "map", nine taps, or "search", of surgeon::load_script
  double round_trip{};               ///< [s]
  double loss{};                     ///< [-], each way
  double assumed_spread{};           ///< [-], of the tissue's stiffness, by the estimator
  double spread{};                   ///< [-], true
  double length{10e-3};              ///< [m], over which it varies
  double scale{1};                   ///< [-], of Young's modulus over the database's
  double modulus{kDatabaseModulus};  ///< [Pa], Young's, as the estimator knows it
  std::uint64_t seed{};
};

/// [m], how far from the middle of such taps, along x and y, a ball lies at most: within the nine
/// places, or somewhere in the middle 30 mm of a field of 50 mm.
[[nodiscard]] double reach_of(const std::string& script) noexcept;

/// The tissue of such a session, as patient::make_phantom reads it; `axis`: where the ball lies.
[[nodiscard]] std::string tissue_words(const LocateSession& session,
                                       const depth::DepthDatabase::Query* ball,
                                       const Place& axis);

/// `ball`: nullptr: plain tissue. `axis`: from the middle of the taps, which is B.
[[nodiscard]] Result<Scenario> locate_scenario(const LocateSession& session,
                                               const depth::DepthDatabase::Query* ball,
                                               const Place& axis);

}  // namespace palp::lab
