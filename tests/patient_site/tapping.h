#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "common/core/filters.h"
#include "patient_site/estimator/paper_estimator.h"
#include "patient_site/simulated_phantom.h"

namespace palp::patient {

/// A hand that taps a simulated phantom and gives what it feels to the paper's estimator, as the
/// patient node would: 1 kHz, position behind the transducer's pole.
struct Tapping {
  int taps{8};
  double indentation{4e-3};  ///< [m], deepest commanded, from the undeformed surface
  double clearance{3e-3};    ///< [m], where a tap begins
  double tap_time{1.0};      ///< [s], raised cosine
  double rest_time{0.5};     ///< [s], after each tap
  double lateral{10e-3};     ///< [m], site B
};

inline std::vector<DepthEstimate> tap(
    const Phantom& phantom,
    SimulatedPhantomConfig config,
    const Tapping& tapping,
    const estimator::PaperEstimatorConfig& estimator_config = {}) {
  config.start_position = config.surface_offset - tapping.clearance;
  config.start_lateral = tapping.lateral;
  SimulatedPhantom site{phantom, config};
  estimator::PaperEstimator estimator{estimator_config};
  LowPass co_filter{20, 1e-3};
  co_filter.reset(config.start_position);
  std::vector<DepthEstimate> estimates;
  const int per_tap = static_cast<int>(std::lround((tapping.tap_time + tapping.rest_time) * 1e3));
  TimePoint now{};
  for (int i = 0; i < tapping.taps * per_tap; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    const std::optional<ForceSample> force = site.sample(now);
    const auto estimate = estimator.add({.at = now,
                                         .position = co_filter.step(stage.position),
                                         .force = force->force,
                                         .lateral = stage.lateral});
    if (estimate) estimates.push_back(*estimate);
    const double t = std::min((i % per_tap) * 1e-3, tapping.tap_time) / tapping.tap_time;
    const double swing = (tapping.indentation + tapping.clearance) / 2;
    site.move_to({config.surface_offset - tapping.clearance +
                      swing * (1 - std::cos(2 * std::numbers::pi * t)),
                  tapping.lateral});
  }
  return estimates;
}

/// No noise, no steps, no damping.
inline SimulatedPhantomConfig ideal_sensor() {
  SimulatedPhantomConfig config;
  config.force_noise = 0;
  config.force_quantum = 0;
  config.viscous_factor = 0;
  return config;
}

}  // namespace palp::patient
