#include "common/record/session_decoder.h"

#include <limits>

#include "proto/session_log.pb.h"

namespace palp::record {
namespace {

/// Collects whether all enumerations and small integers of a message were in range.
struct Range {
  bool ok{true};

  template <class Enum>
  Enum checked(int value, int count) noexcept {
    ok = ok && value >= 0 && value < count;
    return static_cast<Enum>(ok ? value : 0);
  }
  SiteState site_state(int value) noexcept { return checked<SiteState>(value, kSiteStateCount); }
};

template <class Message>
CouplingPayload payload_of(const Message& in) {
  if (in.has_wave()) {
    return WavePayload{.wave_integral = in.wave().wave_integral_sqrt_w_s(),
                       .wave_energy = in.wave().wave_energy_j()};
  }
  if (in.has_tdpa()) {
    return TdpaPayload{.energy_in = in.tdpa().energy_in_j()};
  }
  if (in.has_model()) {
    const auto& model = in.model();
    return ModelPayload{.version = model.version(),
                        .c = {model.c1_n(), model.c2_n(), model.c3_n(), model.c4_n(), model.c5_n()},
                        .surface = model.surface_m(),
                        .depth_max = model.depth_max_m(),
                        .residual = model.residual_n(),
                        .swing = model.swing_m(),
                        .swing_quadrature = model.swing_quadrature_m(),
                        .swing_rate = model.swing_rad_per_s(),
                        .relaxing = {model.relaxing_fast(), model.relaxing_slow()}};
  }
  return {};
}

// The one difference between the sites' ticks: the unit of the command.
double command_of(const session::SurgeonTick& in) { return in.command_n(); }
double command_of(const session::PatientTick& in) { return in.command_m(); }

template <class Message>
Record tick_of(const Message& in, TimePoint at, Range& range) {
  return SiteTick{.at = at,
                  .state = range.site_state(in.state()),
                  .epoch = in.epoch(),
                  .position = in.position_m(),
                  .velocity = in.velocity_m_per_s(),
                  .force = in.force_n(),
                  .lateral = in.lateral_m(),
                  .command = command_of(in),
                  .gate_acted = in.gate_acted(),
                  .round_trip = Duration{in.round_trip_ns()},
                  .sent = {.position = in.sent_position_m(),
                           .velocity = in.sent_velocity_m_per_s(),
                           .force = in.sent_force_n(),
                           .payload = payload_of(in)}};
}

Record arrived_of(const session::ArrivedSample& in, TimePoint at) {
  return Arrived{.at = at,
                 .incoming = {.sample = {.position = in.position_m(),
                                         .velocity = in.velocity_m_per_s(),
                                         .force = in.force_n(),
                                         .payload = payload_of(in)},
                              .number = in.number(),
                              .fresh = in.fresh(),
                              .repaired = in.repaired(),
                              .sent_at = PeerTimePoint{Duration{in.sent_at_ns()}},
                              .arrived_at = TimePoint{Duration{in.arrived_at_ns()}}}};
}

std::optional<ClockOffset> peer_clock_of(const session::LinkStatus& in) {
  if (!in.has_clock_offset_ns()) return std::nullopt;
  return ClockOffset{.offset = Duration{in.clock_offset_ns()},
                     .skew = in.clock_skew(),
                     .uncertainty = Duration{in.clock_uncertainty_ns()},
                     .at = TimePoint{Duration{in.clock_at_ns()}}};
}

Record link_status_of(const session::LinkStatus& in, TimePoint at, Range& range) {
  return LinkStatus{.at = at,
                    .health = {.state = range.checked<LinkState>(in.state(), kLinkStateCount),
                               .gap = Duration{in.gap_ns()},
                               .round_trip = Duration{in.round_trip_ns()},
                               .round_trip_min = Duration{in.round_trip_min_ns()},
                               .jitter = Duration{in.jitter_ns()},
                               .peer_clock = peer_clock_of(in),
                               .delay_out = Duration{in.delay_out_ns()},
                               .delay_in = Duration{in.delay_in_ns()},
                               .sent = in.sent(),
                               .accepted = in.accepted(),
                               .late = in.late(),
                               .repaired = in.repaired(),
                               .lost = in.lost(),
                               .reordered = in.reordered(),
                               .stale = in.stale(),
                               .old_epoch = in.old_epoch(),
                               .unsent = in.unsent(),
                               .malformed = in.malformed(),
                               .foreign = in.foreign(),
                               .replayed = in.replayed(),
                               .too_old = in.too_old(),
                               .forged = in.forged()}};
}

Record event_of(const session::Event& in, TimePoint at, Range& range) {
  range.ok = range.ok && in.code() <= std::numeric_limits<std::uint16_t>::max() &&
             session::Event::Kind_IsValid(in.kind());
  const auto code = static_cast<std::uint16_t>(in.code());
  if (in.kind() == session::Event::TRANSITION) {
    return Transition{.at = at,
                      .from = range.site_state(in.from()),
                      .to = range.site_state(in.to()),
                      .reason = code};
  }
  return Note{.at = at, .code = code, .detail = in.detail()};
}

Record contact_of(const session::ContactSample& in, TimePoint at) {
  return ContactSample{.at = at,
                       .position = in.tip_m(),
                       .force = in.force_n(),
                       .lateral = in.lateral_m(),
                       .position_age = Duration{in.tip_age_ns()},
                       .force_age = Duration{in.force_age_ns()}};
}

/// Any age may stand in a file.
TimePoint earlier(TimePoint at, std::int64_t age_ns) noexcept {
  return TimePoint{
      Duration{static_cast<std::int64_t>(static_cast<std::uint64_t>(at.time_since_epoch().count()) -
                                         static_cast<std::uint64_t>(age_ns))}};
}

Record hand_of(const session::HandReading& in, TimePoint at) {
  return HandReading{.at = at,
                     .sampled_at = earlier(at, in.age_ns()),
                     .position = in.position_m(),
                     .velocity = in.velocity_m_per_s(),
                     .lateral = in.lateral_m(),
                     .pedal_held = in.pedal_held(),
                     .emergency_stop = in.emergency_stop(),
                     .faulted = in.faulted(),
                     .script_phase = in.script_phase()};
}

Record stage_of(const session::StageReading& in, TimePoint at) {
  return StageReading{.at = at,
                      .sampled_at = earlier(at, in.age_ns()),
                      .position = in.position_m(),
                      .velocity = in.velocity_m_per_s(),
                      .lateral = in.lateral_m(),
                      .at_limit = in.at_limit(),
                      .faulted = in.faulted()};
}

Record force_of(const session::ForceReading& in, TimePoint at) {
  return ForceReading{.at = at,
                      .fresh = in.fresh(),
                      .sampled_at = earlier(at, in.age_ns()),
                      .force = in.force_n(),
                      .saturated = in.saturated()};
}

Record heard_of(const session::LinkHeard& in, TimePoint at, Range& range) {
  range.ok = range.ok && in.key() <= std::numeric_limits<std::uint8_t>::max();
  return LinkHeard{.at = at,
                   .state = range.checked<LinkState>(in.state(), kLinkStateCount),
                   .session_id = in.session_id(),
                   .gap = Duration{in.gap_ns()},
                   .round_trip = Duration{in.round_trip_ns()},
                   .key = static_cast<std::uint8_t>(in.key()),
                   .peer_heard = in.peer_heard(),
                   .peer_state = range.site_state(in.peer_state()),
                   .peer_epoch = in.peer_epoch(),
                   .peer_lateral = in.peer_lateral_m(),
                   .depth_number = in.depth_number()};
}

Record user_of(const session::UserCommand& in, TimePoint at) {
  return UserAsked{.at = at, .command = {in.emergency_stop(), in.resets()}};
}

Record devices_of(const session::Devices& in, TimePoint at) {
  DevicesTold told{.at = at, .of_peer = in.of_peer(), .facts = {}};
  if (in.has_hand()) {
    told.facts.hand = HandFacts{.axes = in.hand().axes(),
                                .force_peak = in.hand().force_peak_n(),
                                .force_continuous = in.hand().force_continuous_n(),
                                .rate = in.hand().rate_hz()};
  }
  if (in.has_stage()) {
    told.facts.stage = StageFacts{.axes = in.stage().axes(),
                                  .travel_min = in.stage().travel_min_m(),
                                  .travel_max = in.stage().travel_max_m(),
                                  .travel_side = in.stage().travel_side_m(),
                                  .speed = in.stage().speed_m_per_s(),
                                  .acceleration = in.stage().acceleration_m_per_s2(),
                                  .rate = in.stage().rate_hz(),
                                  .lag = in.stage().lag_s(),
                                  .drags = in.stage().drags()};
  }
  if (in.has_sensor()) {
    told.facts.sensor = ForceSensorFacts{.pole = in.sensor().pole_hz(),
                                         .step = in.sensor().step_n(),
                                         .range = in.sensor().range_n(),
                                         .noise = in.sensor().noise_n(),
                                         .rate = in.sensor().rate_hz(),
                                         .lag = in.sensor().lag_s()};
  }
  return told;
}

Record estimate_of(const session::DepthEstimate& in, Range& range) {
  return DepthEstimate{.number = in.number(),
                       .stroke_began_at = TimePoint{Duration{in.stroke_began_at_ns()}},
                       .stroke_ended_at = TimePoint{Duration{in.stroke_ended_at_ns()}},
                       .lateral = in.lateral_m(),
                       .indentation_max = in.indentation_max_m(),
                       .force_max = in.force_max_n(),
                       .surface = in.surface_m(),
                       .verdict = range.checked<DepthVerdict>(in.verdict(), kDepthVerdictCount),
                       .reason = range.checked<DepthReason>(in.reason(), kDepthReasonCount),
                       .hash = in.hash_n(),
                       .depth = in.depth_m(),
                       .depth_stddev = in.depth_stddev_m(),
                       .depth_low = in.depth_low_m(),
                       .depth_high = in.depth_high_m(),
                       .fit_rms = in.fit_rms_n()};
}

Record report_of(const session::DepthReport& in, TimePoint at, Range& range) {
  return DepthArrived{
      .at = at,
      .report = {.number = in.number(),
                 .verdict = range.checked<DepthVerdict>(in.verdict(), kDepthVerdictCount),
                 .reason = range.checked<DepthReason>(in.reason(), kDepthReasonCount),
                 .depth = in.depth_m(),
                 .depth_stddev = in.depth_stddev_m(),
                 .depth_low = in.depth_low_m(),
                 .depth_high = in.depth_high_m(),
                 .hash = in.hash_n()}};
}

}  // namespace

struct SessionDecoder::Messages {
  session::SurgeonTick surgeon_tick;
  session::PatientTick patient_tick;
  session::SurgeonTickView surgeon_view;
  session::PatientTickView patient_view;
  session::ArrivedSample arrived;
  session::LinkStatus link;
  session::Event event;
  session::ContactSample contact;
  session::DepthEstimate estimate;
  session::DepthReport report;
  session::HandReading hand;
  session::StageReading stage;
  session::ForceReading force;
  session::LinkHeard heard;
  session::UserCommand user;
  session::Devices devices;
};

SessionDecoder::SessionDecoder() : messages_{std::make_unique<Messages>()} {}
SessionDecoder::~SessionDecoder() = default;

SessionDecoder::Answer SessionDecoder::decode(std::string_view schema,
                                              std::span<const std::byte> payload,
                                              TimePoint at) {
  Messages& from = *messages_;
  Range range;
  Answer answer{.verdict = Verdict::Unknown, .record = {}};
  // Parses `payload` if the schema is that of `message`; then `convert` makes the record.
  const auto attempt = [&](auto& message, auto convert) {
    if (answer.verdict != Verdict::Unknown || schema != message.GetDescriptor()->full_name()) {
      return;
    }
    answer.verdict = Verdict::Malformed;
    if (payload.size() <= std::numeric_limits<int>::max() &&
        message.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
      answer.verdict = convert();
    }
  };
  const auto record = [&](Record value) {
    answer.record = value;
    return range.ok ? Verdict::Decoded : Verdict::Malformed;
  };
  const auto view = [] { return Verdict::View; };
  attempt(from.surgeon_tick, [&] { return record(tick_of(from.surgeon_tick, at, range)); });
  attempt(from.patient_tick, [&] { return record(tick_of(from.patient_tick, at, range)); });
  attempt(from.arrived, [&] { return record(arrived_of(from.arrived, at)); });
  attempt(from.hand, [&] { return record(hand_of(from.hand, at)); });
  attempt(from.stage, [&] { return record(stage_of(from.stage, at)); });
  attempt(from.force, [&] { return record(force_of(from.force, at)); });
  attempt(from.heard, [&] { return record(heard_of(from.heard, at, range)); });
  attempt(from.user, [&] { return record(user_of(from.user, at)); });
  attempt(from.devices, [&] { return record(devices_of(from.devices, at)); });
  attempt(from.contact, [&] { return record(contact_of(from.contact, at)); });
  attempt(from.link, [&] { return record(link_status_of(from.link, at, range)); });
  attempt(from.event, [&] { return record(event_of(from.event, at, range)); });
  attempt(from.estimate, [&] { return record(estimate_of(from.estimate, range)); });
  attempt(from.report, [&] { return record(report_of(from.report, at, range)); });
  attempt(from.surgeon_view, view);
  attempt(from.patient_view, view);
  return answer;
}

}  // namespace palp::record
