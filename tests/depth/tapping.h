#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "common/core/filters.h"
#include "depth/cubic_fit.h"
#include "depth/depth_estimator.h"
#include "depth/paper_hash.h"
#include "patient_site/simulated_phantom.h"

namespace palp::patient {

/// The phantom of a ball with its curve at B and the plain block at A: where a single place is
/// judged, what is left of the ball 20 mm beside it is not the question.
inline Result<Phantom> plain_at_a(std::string_view spec) {
  auto phantom = make_phantom(spec);
  if (phantom) phantom->block.reset();
  return phantom;
}

/// A hand that taps a simulated phantom.
struct Tapping {
  int taps{8};
  double indentation{4e-3};  ///< [m], deepest commanded, from the undeformed surface
  double clearance{3e-3};    ///< [m], where a tap begins
  double tap_time{1.0};      ///< [s], raised cosine
  double rest_time{0.5};     ///< [s], after each tap
  Place place{kSiteB};
  int hesitant{0};  ///< so many taps, the first ones, go back near their end, and on
};

/// Where the tip is wanted, from the undeformed surface; `t`: share of the tap's time.
inline double tapped_position(const Tapping& tapping, bool hesitant, double t) {
  const auto wave = [](double share) { return 1 - std::cos(2 * std::numbers::pi * share); };
  const double smooth =
      -tapping.clearance + (tapping.indentation + tapping.clearance) / 2 * wave(t);
  constexpr double kFrom = 0.36;
  constexpr double kSpan = 0.2;
  constexpr double kBack = 2.5e-3;  // [m]: more than the way on meanwhile
  if (!hesitant || t < kFrom || t > kFrom + kSpan) return smooth;
  return smooth - kBack / 2 * wave((t - kFrom) / kSpan);
}

/// Gives `feel` every sample, as the patient node would: 1 kHz, as the devices gave it. @returns
/// the instant of the last one.
template <typename Feel>
TimePoint feel_taps(const Phantom& phantom,
                    SimulatedPhantomConfig config,
                    const Tapping& tapping,
                    TimePoint now,
                    const Feel& feel) {
  config.start_position = config.surface_offset - tapping.clearance;
  config.start_place = tapping.place;
  SimulatedPhantom site{phantom, config};
  const int per_tap = static_cast<int>(std::lround((tapping.tap_time + tapping.rest_time) * 1e3));
  for (int i = 0; i < tapping.taps * per_tap; ++i) {
    now += std::chrono::milliseconds{1};
    const StageState stage = site.read(now);
    const std::optional<ForceSample> force = site.sample(now);
    feel(ContactSample{
        .at = now, .position = stage.position, .force = force->force, .place = stage.place});
    const double t = std::min((i % per_tap) * 1e-3, tapping.tap_time) / tapping.tap_time;
    const bool hesitant = i / per_tap < tapping.hesitant;
    site.move_to({config.surface_offset + tapped_position(tapping, hesitant, t), tapping.place});
  }
  return now;
}

/// The paper's estimator.
inline depth::DepthEstimatorConfig paper_estimator(const depth::StrokeTrackerConfig& strokes = {}) {
  depth::DepthEstimatorConfig config;
  config.kind = depth::EstimatorKind::Paper;
  config.strokes = strokes;
  return config;
}

/// What the paper's estimator says of such taps.
inline std::vector<DepthEstimate> tap(const Phantom& phantom,
                                      const SimulatedPhantomConfig& config,
                                      const Tapping& tapping,
                                      const depth::StrokeTrackerConfig& strokes = {}) {
  depth::DepthEstimator estimator{paper_estimator(strokes)};
  std::vector<DepthEstimate> estimates;
  feel_taps(phantom, config, tapping, {}, [&](const ContactSample& sample) {
    if (const auto estimate = estimator.add(sample)) estimates.push_back(*estimate);
  });
  return estimates;
}

/// What the tracker says of such taps; their places' touches are gone.
inline std::vector<depth::Stroke> strokes_of(const Phantom& phantom,
                                             const SimulatedPhantomConfig& config,
                                             const Tapping& tapping,
                                             const depth::StrokeTrackerConfig& tracking = {}) {
  depth::StrokeTracker tracker{tracking};
  std::vector<depth::Stroke> strokes;
  feel_taps(phantom, config, tapping, {}, [&](const ContactSample& sample) {
    auto stroke = tracker.take(sample);
    if (!stroke) return;
    stroke->known.touches = {};
    strokes.push_back(*stroke);
  });
  return strokes;
}

/// The paper's h of a table.
inline double hash_of(const ForceTable& table) {
  std::vector<depth::CurvePoint> points;
  for (int i = 0; i <= 80; ++i) points.push_back({i * 50e-6, table.force(i * 50e-6)});
  return depth::hash(*depth::fit_cubic(points));
}

/// The median h of strokes or estimates.
template <typename List>
double median_hash(const List& list) {
  std::vector<double> values;
  for (const auto& one : list) values.push_back(one.hash);
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

/// Gives `feel` taps beside the inclusion, at 0, and as many over it, at 20 mm.
template <typename Feel>
void palpate(const Phantom& phantom,
             const SimulatedPhantomConfig& sensor,
             Tapping tapping,
             const Feel& feel) {
  TimePoint now{};
  for (const Place& place : {kSiteA, kSiteB}) {
    SimulatedPhantomConfig config = sensor;
    config.seed += static_cast<std::uint64_t>(place.x * 1e3);
    tapping.place = place;
    now = feel_taps(phantom, config, tapping, now, feel);
  }
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
