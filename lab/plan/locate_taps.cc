#include "lab/plan/locate_taps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace palp::lab {
namespace {

constexpr double kTableStep = 20e-6;       // [m], of a place's table
constexpr double kSurfaceSpread = 0.2e-3;  // [m], of the surface from place to place
constexpr double kRest = 0.2;              // [s], after a tap

/// As hands tap.
TapMotion drawn_motion(LocateDraws& draws) {
  TapMotion out;
  out.span = draws.uniform(0.7, 1.4);
  out.reach = draws.uniform(3.6e-3, 4.2e-3);
  return out;
}

}  // namespace

patient::ForceTable table_at(const depth::DepthDatabase& database,
                             const depth::DepthDatabase::Curve& curve,
                             double scale,
                             const std::function<double(double)>& share) {
  std::vector<patient::ForceRow> rows;
  const depth::DepthDatabase::Curve plain = database.plain();
  const int count = static_cast<int>(curve.indentation_max / kTableStep + 1e-6);
  for (int i = 0; i <= count; ++i) {
    const double d = i * kTableStep;
    const double excess = database.log_excess(curve, d) * share(d);
    rows.push_back({d, scale * database.force(plain, d) * std::exp(excess)});
  }
  return *patient::ForceTable::make(std::move(rows));
}

TimePoint tap(const patient::Phantom& phantom,
              patient::SimulatedPhantomConfig config,
              double reach_max,
              const std::optional<TapMotion>& motion,
              LocateDraws& draws,
              TimePoint now,
              const Feel& feel) {
  config.surface_offset = kSurfaceSpread * draws.normal();
  config.seed = draws.bits();
  const TapMotion way = motion ? *motion : drawn_motion(draws);
  const double reach = std::min(way.reach, reach_max);
  config.start_position = config.surface_offset - way.clearance;
  patient::SimulatedPhantom site{phantom, config};
  const int samples = static_cast<int>((way.span + kRest) * 1e3);
  for (int i = 0; i < samples; ++i) {
    now += std::chrono::milliseconds{1};
    const patient::StageState stage = site.read(now);
    const auto force = site.sample(now);
    if (force) {
      feel(ContactSample{
          .at = now, .position = stage.position, .force = force->force, .place = stage.place});
    }
    const double t = std::min(i * 1e-3, way.span) / way.span;
    const double depth =
        -way.clearance + 0.5 * (reach + way.clearance) * (1 - std::cos(2 * std::numbers::pi * t));
    site.move_to({config.surface_offset + depth, config.start_place});
  }
  return now + std::chrono::seconds{1};
}

std::optional<depth::PlaceData> Palpation::touch(const Place& at) {
  const depth::StrokeTrackerConfig strokes;
  std::optional<depth::PlaceData> out;
  now_ = tap_at_(at, now_, [&](const ContactSample& sample) {
    const auto stroke = tracker_.take(sample);
    if (!stroke || stroke->reason != DepthReason::Ok) return;
    out = depth::place_data({.place = at,
                             .touches = stroke->known.touches,
                             .surface = stroke->known.surface,
                             .noise = stroke->known.noise,
                             .quantum = strokes.sensor.step,
                             .cut_off = strokes.sensor.pole,
                             .stiffness = stiffness_},
                            *basis_);
  });
  return out;
}

}  // namespace palp::lab
