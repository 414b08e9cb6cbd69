#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "common/record/session_writer.h"
#include "judge/excursions.h"
#include "review/site_data.h"

/// A made-up session whose every number is known: the hand taps a linear tissue.
namespace palp::review::test {

inline constexpr double kSurface = 2e-3;  ///< [m]
inline constexpr double kFeltA = 120;     ///< [N/m], what the surgeon is given
inline constexpr double kFeltB = 180;     ///< [N/m]
inline constexpr Duration kClockOffset{std::chrono::seconds{77}};  ///< patient's minus surgeon's
inline constexpr Duration kWay{std::chrono::milliseconds{10}};

inline TimePoint at_ms(std::int64_t value) { return TimePoint{std::chrono::milliseconds{value}}; }

/// Lines through the origin: 100 N/m at A, 200 N/m at B, to 6 mm.
inline const std::string kTissueCsv{"site,d_mm,F_N\nA,0,0\nA,6,0.6\nB,0,0\nB,3,0.6\nB,6,1.2\n"};

struct SampleOptions {
  int taps_per_place{3};
  int unseen_stroke{-1};  ///< this stroke (0, 1, ...) is missing in the patient's file
  bool reports{true};     ///< the estimates arrive at the surgeon's
};

struct SampleFiles {
  std::vector<std::byte> surgeon;
  std::vector<std::byte> patient;
};

inline std::vector<std::byte> bytes_of(const record::MemorySink& sink) {
  return {sink.bytes().begin(), sink.bytes().end()};
}

/// Hand 0.8 s in, from -3 mm to 4 mm past the surface and back, then 0.2 s rest; A first, then B.
inline SiteTick hand_tick(std::int64_t ms, int taps_per_place) {
  const auto tap = ms / 1000;
  const double phase = static_cast<double>(ms % 1000) / 800;
  const bool moving = phase < 1;
  constexpr double kTurn = 2 * std::numbers::pi;
  const double lift = moving ? 0.5 * (1 - std::cos(kTurn * phase)) : 0;
  const double velocity = moving ? 0.5 * std::sin(kTurn * phase) * kTurn / 0.8 * 7e-3 : 0;
  const bool at_b = tap >= taps_per_place;
  const double past = -3e-3 + 7e-3 * lift;
  return {.at = at_ms(ms),
          .state = SiteState::Engaged,
          .epoch = 1,
          .position = kSurface + past,
          .velocity = velocity,
          .force = past > 0 ? (at_b ? kFeltB : kFeltA) * past : 0,
          .place = at_b ? kSiteB : kSiteA,
          .command = 0,
          .gate_acted = false,
          .round_trip = 2 * kWay,
          .sent = {}};
}

inline SampleFiles sample_session(const SampleOptions& options = {}) {
  record::MemorySink surgeon_sink;
  record::MemorySink patient_sink;
  {
    record::SessionWriter surgeon{
        surgeon_sink,
        {.site = link::Role::Surgeon, .metadata = {{"seed", "42"}, {"coupling", "direct"}}}};
    record::SessionWriter patient{patient_sink,
                                  {.site = link::Role::Patient,
                                   .metadata = {{"surface_offset_mm", "2"},
                                                {"phantom_name", "paper-10mm"},
                                                {"phantom_depth_mm", "10"},
                                                {"phantom_radius_mm", "15"},
                                                {"phantom_ratio", "856.2"},
                                                {"phantom_shape", "ball"},
                                                {"estimator", "paper"}},
                                   .attachments = {{"tissue.csv", "text/csv", kTissueCsv}}}};
    const int strokes = 2 * options.taps_per_place;
    for (std::int64_t ms = 0; ms < std::int64_t{1000} * strokes; ++ms) {
      const SiteTick tick = hand_tick(ms, options.taps_per_place);
      surgeon.write(tick);
      const TimePoint there = tick.at + kClockOffset + kWay;
      if (ms % 100 == 0) {
        LinkHealth health;
        health.state = LinkState::Live;
        health.round_trip = 2 * kWay;
        health.late = 5;
        health.forged = 2;
        surgeon.write(LinkStatus{.at = tick.at, .health = health});
      }
      const int stroke = static_cast<int>(ms / 1000);
      if (ms % 1000 == 400 && stroke != options.unseen_stroke) {
        const bool at_b = stroke >= options.taps_per_place;
        const auto number = static_cast<std::uint32_t>(stroke + 1);
        if (options.reports) {
          const TimePoint heard = tick.at + 2 * kWay;
          surgeon.write(DepthArrived{.at = heard, .report = {.number = number}});
        }
        patient.write(DepthEstimate{.number = number,
                                    .stroke_began_at = there - std::chrono::milliseconds{180},
                                    .stroke_ended_at = there,
                                    .place = at_b ? kSiteB : kSiteA,
                                    .indentation_max = 4e-3,
                                    .force_max = at_b ? 0.8 : 0.4,
                                    .surface = kSurface,
                                    .verdict = at_b ? DepthVerdict::Found : DepthVerdict::None,
                                    .reason = DepthReason::Ok,
                                    .hash = at_b ? 0.069 : 0.059,
                                    .depth = at_b ? 0.0098 + 1e-4 * stroke : 0,
                                    .depth_stddev = 0,
                                    .depth_low = at_b ? 0.0098 + 1e-4 * stroke : 0,
                                    .depth_high = at_b ? 0.0098 + 1e-4 * stroke : 0,
                                    .fit_rms = 0.001});
      }
    }
    surgeon.write(Transition{at_ms(500), SiteState::Clutched, SiteState::Engaged, 2});
  }
  return {bytes_of(surgeon_sink), bytes_of(patient_sink)};
}

/// The hand's motion of such a session.
inline std::vector<judge::Motion> hand_motion(int taps_per_place) {
  std::vector<judge::Motion> motion;
  for (std::int64_t ms = 0; ms < std::int64_t{2000} * taps_per_place; ++ms) {
    const auto tick = hand_tick(ms, taps_per_place);
    motion.push_back({tick.at, tick.position, tick.velocity, tick.force, tick.place});
  }
  return motion;
}

inline std::vector<judge::Excursion> find_excursions(const std::vector<judge::Motion>& motion,
                                                     double surface,
                                                     const judge::TissueTable* tissue = nullptr) {
  judge::ExcursionFinder finder{surface, tissue};
  std::vector<judge::Excursion> found;
  for (const judge::Motion& tick : motion) {
    if (const auto one = finder.look(tick)) found.push_back(*one);
  }
  if (const auto one = finder.finish()) found.push_back(*one);
  return found;
}

struct LoadedSession {
  SiteData surgeon;
  SiteData patient;
};

inline LoadedSession load(const SampleFiles& files) {
  return {load_site(files.surgeon, "s", link::Role::Surgeon).value(),
          load_site(files.patient, "p", link::Role::Patient).value()};
}

}  // namespace palp::review::test
