#pragma once

#include "fem/depth_database.h"
#include "patient_site/estimator/depth_posterior.h"

namespace palp::lab {

/// Taps of one phantom and the sensor they are felt with.
struct TapPlan {
  int taps{4};
  int reference_taps{4};       ///< beside the inclusion
  double indentation{4e-3};    ///< [m], deepest
  double clearance{10e-3};     ///< [m], where a tap begins
  double tap_time{1.0};        ///< [s], raised cosine there and back
  double force_noise{0.015};   ///< [N], rms of a sample before the steps
  double force_quantum{0.05};  ///< [N]; 0: none
  double sensor_cut_off{20};   ///< [Hz]
  double period{1e-3};         ///< [s]
};

/// What the measurement allows, whoever estimates.
struct DepthBound {
  double depth_stddev{};  ///< [m], Cramer-Rao bound of the depth, prior knowledge counted in
  double signal{};        ///< [-], standard deviations by which the inclusion differs from none
};

/// Fisher information of quantised samples, loading and unloading as the estimator hears them,
/// about depth, radius, ratio, stiffness, rate factor and both surfaces, from derivatives of the
/// database's curves.
[[nodiscard]] DepthBound depth_bound(const fem::DepthDatabase& database,
                                     const fem::DepthDatabase::Query& truth,
                                     const estimator::DepthPrior& prior,
                                     const estimator::StiffnessPrior& stiffness,
                                     const TapPlan& plan);

/// Information of one sample about its mean, in 1/N^2: Gauss noise, then rounding to steps.
[[nodiscard]] double sample_information(double force, double noise, double quantum);

}  // namespace palp::lab
