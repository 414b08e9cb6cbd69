#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "common/record/session_writer.h"

/// Builders and comparisons for the tests of this room.
namespace palp::record::test {

inline TimePoint at_ms(std::int64_t value) { return TimePoint{std::chrono::milliseconds{value}}; }

inline SiteTick tick(std::int64_t ms) {
  return {.at = at_ms(ms),
          .state = SiteState::Engaged,
          .epoch = 3,
          .position = 1e-3 * static_cast<double>(ms % 7),
          .velocity = -0.02,
          .force = 0.25,
          .lateral = 0.01,
          .command = 0.125,
          .gate_acted = ms % 5 == 0,
          .round_trip = Duration{12345678},
          .sent = {.position = 1e-3, .velocity = 0.5, .force = 0.25, .payload = {}}};
}

/// The bits of a double: NaN equals itself, +0 does not equal -0.
inline std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

using Fields = std::vector<std::uint64_t>;

inline void add_fields(Fields& out, double value) { out.push_back(bits(value)); }
template <std::integral T>
void add_fields(Fields& out, T value) {
  out.push_back(static_cast<std::uint64_t>(value));
}
template <class T>
requires std::is_enum_v<T>
void add_fields(Fields& out, T value) { out.push_back(static_cast<std::uint64_t>(value)); }
inline void add_fields(Fields& out, Duration value) { add_fields(out, value.count()); }
template <class Line>
void add_fields(Fields& out, std::chrono::time_point<Line> value) {
  add_fields(out, value.time_since_epoch().count());
}
inline void add_fields(Fields& out, const PortSample& sample);
template <class... Ts>
void add_all(Fields& out, const Ts&... values) {
  (add_fields(out, values), ...);
}

inline void add_fields(Fields& out, const std::monostate&) { out.push_back(0); }
inline void add_fields(Fields& out, const WavePayload& wave) {
  add_all(out, wave.wave_integral, wave.wave_energy);
}
inline void add_fields(Fields& out, const TdpaPayload& tdpa) { add_fields(out, tdpa.energy_in); }
inline void add_fields(Fields& out, const ModelPayload& model) {
  add_all(out,
          model.version,
          model.c[0],
          model.c[1],
          model.c[2],
          model.c[3],
          model.c[4],
          model.surface,
          model.depth_max,
          model.residual,
          model.swing,
          model.swing_quadrature,
          model.swing_rate,
          model.relaxing[0],
          model.relaxing[1]);
}
inline void add_fields(Fields& out, const PortSample& sample) {
  add_all(out, sample.position, sample.velocity, sample.force, sample.payload.index());
  std::visit([&](const auto& payload) { add_fields(out, payload); }, sample.payload);
}
inline void add_fields(Fields& out, const SiteTick& t) {
  add_all(out,
          t.at,
          t.state,
          t.epoch,
          t.position,
          t.velocity,
          t.force,
          t.lateral,
          t.command,
          t.gate_acted,
          t.round_trip,
          t.sent);
}
inline void add_fields(Fields& out, const Arrived& a) {
  add_all(out,
          a.at,
          a.incoming.sample,
          a.incoming.number,
          a.incoming.fresh,
          a.incoming.repaired,
          a.incoming.sent_at,
          a.incoming.arrived_at);
}
inline void add_fields(Fields& out, const LinkStatus& s) {
  const LinkHealth& h = s.health;
  const ClockOffset clock = h.peer_clock.value_or(ClockOffset{});
  add_all(out,
          s.at,
          h.state,
          h.gap,
          h.round_trip,
          h.round_trip_min,
          h.jitter,
          h.peer_clock.has_value(),
          clock.offset,
          clock.skew,
          clock.uncertainty,
          clock.at,
          h.delay_out,
          h.delay_in,
          h.sent,
          h.accepted,
          h.late,
          h.repaired,
          h.lost,
          h.reordered,
          h.stale,
          h.old_epoch,
          h.unsent,
          h.malformed,
          h.foreign,
          h.replayed,
          h.too_old,
          h.forged);
}
inline void add_fields(Fields& out, const Note& n) { add_all(out, n.at, n.code, n.detail); }
inline void add_fields(Fields& out, const Transition& t) {
  add_all(out, t.at, t.from, t.to, t.reason);
}
inline void add_fields(Fields& out, const ContactSample& c) {
  add_all(out, c.at, c.position, c.force, c.lateral, c.position_age, c.force_age);
}
inline void add_fields(Fields& out, const HandReading& h) {
  add_all(out, h.at, h.sampled_at, h.position, h.velocity, h.lateral);
  add_all(out, h.pedal_held, h.emergency_stop, h.faulted, h.script_phase);
}
inline void add_fields(Fields& out, const StageReading& s) {
  add_all(out, s.at, s.sampled_at, s.position, s.velocity, s.lateral, s.at_limit, s.faulted);
}
inline void add_fields(Fields& out, const ForceReading& f) {
  add_all(out, f.at, f.fresh, f.sampled_at, f.force, f.saturated);
}
inline void add_fields(Fields& out, const LinkHeard& h) {
  add_all(out, h.at, h.state, h.session_id, h.gap, h.round_trip, h.key, h.peer_heard);
  add_all(out, h.peer_state, h.peer_epoch, h.peer_lateral, h.depth_number);
}
inline void add_fields(Fields& out, const UserAsked& u) {
  add_all(out, u.at, u.command.emergency_stop, u.command.resets);
}
inline void add_fields(Fields& out, const DevicesTold& d) {
  add_all(out, d.at, d.of_peer, d.facts.hand.has_value());
  add_all(out, d.facts.stage.has_value(), d.facts.sensor.has_value());
  if (const auto& hand = d.facts.hand) {
    add_all(out, hand->axes, hand->force_peak, hand->force_continuous, hand->rate);
  }
  if (const auto& stage = d.facts.stage) {
    add_all(out, stage->axes, stage->travel_min, stage->travel_max, stage->travel_side);
    add_all(out, stage->speed, stage->acceleration, stage->rate, stage->lag, stage->drags);
  }
  if (const auto& sensor = d.facts.sensor) {
    add_all(out, sensor->pole, sensor->step, sensor->range, sensor->noise, sensor->rate);
    add_all(out, sensor->lag);
  }
}
inline void add_fields(Fields& out, const DepthEstimate& e) {
  add_all(out,
          e.number,
          e.stroke_began_at,
          e.stroke_ended_at,
          e.lateral,
          e.indentation_max,
          e.force_max,
          e.surface,
          e.verdict,
          e.reason,
          e.hash,
          e.depth,
          e.depth_stddev,
          e.depth_low,
          e.depth_high,
          e.fit_rms);
}
inline void add_fields(Fields& out, const DepthArrived& d) {
  const DepthReport& r = d.report;
  add_all(out,
          d.at,
          r.number,
          r.verdict,
          r.reason,
          r.depth,
          r.depth_stddev,
          r.depth_low,
          r.depth_high,
          r.hash);
}

/// Every field of a record, bit for bit: two records are the same if these are.
inline Fields fields(const Record& record) {
  Fields out{record.index()};
  std::visit([&](const auto& value) { add_fields(out, value); }, record);
  return out;
}

/// A patient's file of `ticks` ticks with notes and one estimate, in chunks of `chunk_ms`.
inline std::vector<std::byte> small_session(int ticks, int chunk_ms) {
  MemorySink sink;
  McapOptions options;
  options.chunk_span_max = std::chrono::milliseconds{chunk_ms};
  SessionWriter writer{sink,
                       {.site = link::Role::Patient,
                        .metadata = {{"seed", "7"}},
                        .attachments = {{"tissue.csv", "text/csv", "site,d_mm,F_N\nA,0,0\n"}}},
                       options};
  for (int k = 0; k < ticks; ++k) {
    writer.write(tick(k), at_ms(k));
    if (k % 10 == 3) {
      writer.write(Note{.at = at_ms(k), .code = 33, .detail = 1.5}, at_ms(k));
    }
  }
  writer.write(DepthEstimate{.number = 1, .stroke_ended_at = at_ms(ticks)}, at_ms(ticks));
  writer.close();
  return {sink.bytes().begin(), sink.bytes().end()};
}

}  // namespace palp::record::test
