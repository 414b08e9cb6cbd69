#pragma once

#include <span>
#include <vector>

#include "common/core/device_facts.h"
#include "depth/depth_database.h"
#include "depth/depth_posterior.h"

namespace palp::lab {

/// Taps of one phantom and the sensor they are felt with.
struct TapPlan {
  int taps{4};
  int reference_taps{4};     ///< beside the inclusion
  double indentation{4e-3};  ///< [m], deepest
  double clearance{10e-3};   ///< [m], where a tap begins
  double tap_time{1.0};      ///< [s], raised cosine there and back
  ForceSensorFacts sensor{};
};

/// Where the tip is while one sample is taken.
struct TipState {
  double indentation{};  ///< [m], negative in the air
  double rate{};         ///< [m/s]
  bool over{};           ///< the inclusion, not beside it
};

/// Sample by sample, up to the reversal of the last tap: then the answer is there.
[[nodiscard]] std::vector<TipState> motion_of(const TapPlan& plan);

/// What the measurement allows, whoever estimates.
struct DepthBound {
  double depth_stddev{};  ///< [m], Cramer-Rao bound of the depth, prior knowledge counted in
  double signal{};        ///< [-], standard deviations by which the inclusion differs from none
};

/// Fisher information of quantised samples about depth, radius, ratio, stiffness, rate factor and
/// both surfaces, from derivatives of the database's curves, which pass the sensor's pole as
/// the force does. `stiffness.scale` and `.rate_factor` are the true ones.
[[nodiscard]] DepthBound depth_bound(const depth::DepthDatabase& database,
                                     const depth::DepthDatabase::Query& truth,
                                     const depth::DepthPrior& prior,
                                     const depth::StiffnessPrior& stiffness,
                                     const ForceSensorFacts& sensor,
                                     std::span<const TipState> motion);

/// Information of one sample about its mean, in 1/N^2: Gauss noise, then rounding to steps.
[[nodiscard]] double sample_information(double force, double noise, double quantum);

}  // namespace palp::lab
