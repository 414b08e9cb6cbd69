#include "common/record/session_encoder.h"

#include "common/record/notes.h"
#include "proto/session_log.pb.h"

namespace palp::record {
namespace {

using link::Role;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

/// Enumerations of the file and of the house have the same numbers (checked below).
template <class Message, class Enum>
Message to_wire(Enum value) noexcept {
  return static_cast<Message>(value);
}
static_assert(session::STOPPED == static_cast<int>(SiteState::Stopped));
static_assert(session::LINK_LOST == static_cast<int>(LinkState::Lost));
static_assert(session::INVALID == static_cast<int>(DepthVerdict::Invalid));
static_assert(session::TOO_NOISY == static_cast<int>(DepthReason::TooNoisy));

template <class Message>
void put_payload(const CouplingPayload& payload, Message& out) {
  std::visit(Overloaded{[&](const std::monostate&) { out.clear_payload(); },
                        [&](const WavePayload& wave) {
                          out.mutable_wave()->set_wave_integral_sqrt_w_s(wave.wave_integral);
                          out.mutable_wave()->set_wave_energy_j(wave.wave_energy);
                        },
                        [&](const TdpaPayload& tdpa) {
                          out.mutable_tdpa()->set_energy_in_j(tdpa.energy_in);
                        },
                        [&](const ModelPayload& model) {
                          auto& to = *out.mutable_model();
                          to.set_version(model.version);
                          to.set_c1_n(model.c[0]);
                          to.set_c2_n(model.c[1]);
                          to.set_c3_n(model.c[2]);
                          to.set_c4_n(model.c[3]);
                          to.set_c5_n(model.c[4]);
                          to.set_surface_m(model.surface);
                          to.set_depth_max_m(model.depth_max);
                          to.set_residual_n(model.residual);
                          to.set_swing_m(model.swing);
                          to.set_swing_quadrature_m(model.swing_quadrature);
                          to.set_swing_rad_per_s(model.swing_rate);
                          to.set_relaxing_fast(model.relaxing[0]);
                          to.set_relaxing_slow(model.relaxing[1]);
                        }},
             payload);
}

// The one difference between the sites' ticks: the unit of the command.
void put_command(double command, session::SurgeonTick& out) { out.set_command_n(command); }
void put_command(double command, session::PatientTick& out) { out.set_command_m(command); }
void put_command(const SignalView& command, session::SurgeonTickView& out) {
  out.set_command_n(command.newest);
  out.set_command_min_n(command.min);
  out.set_command_max_n(command.max);
}
void put_command(const SignalView& command, session::PatientTickView& out) {
  out.set_command_m(command.newest);
  out.set_command_min_m(command.min);
  out.set_command_max_m(command.max);
}

template <class Message>
void put_tick(const SiteTick& tick, Message& out) {
  out.set_state(to_wire<session::SiteState>(tick.state));
  out.set_epoch(tick.epoch);
  out.set_position_m(tick.position);
  out.set_velocity_m_per_s(tick.velocity);
  out.set_force_n(tick.force);
  out.set_lateral_m(tick.lateral);
  put_command(tick.command, out);
  out.set_gate_acted(tick.gate_acted);
  out.set_round_trip_ns(tick.round_trip.count());
  out.set_sent_position_m(tick.sent.position);
  out.set_sent_velocity_m_per_s(tick.sent.velocity);
  out.set_sent_force_n(tick.sent.force);
  put_payload(tick.sent.payload, out);
}

template <class Message>
void put_view(const TickView& view, Message& out) {
  out.set_state(to_wire<session::SiteState>(view.newest.state));
  out.set_ticks(view.ticks);
  out.set_gate_acted(view.gate_acted);
  out.set_position_m(view.position.newest);
  out.set_position_min_m(view.position.min);
  out.set_position_max_m(view.position.max);
  out.set_velocity_m_per_s(view.velocity.newest);
  out.set_velocity_min_m_per_s(view.velocity.min);
  out.set_velocity_max_m_per_s(view.velocity.max);
  out.set_force_n(view.force.newest);
  out.set_force_min_n(view.force.min);
  out.set_force_max_n(view.force.max);
  put_command(view.command, out);
  out.set_lateral_m(view.newest.lateral);
  out.set_round_trip_ns(view.newest.round_trip.count());
}

void put(const Arrived& arrived, session::ArrivedSample& out) {
  const Incoming& incoming = arrived.incoming;
  out.set_number(incoming.number);
  out.set_fresh(incoming.fresh);
  out.set_repaired(incoming.repaired);
  out.set_sent_at_ns(incoming.sent_at.time_since_epoch().count());
  out.set_arrived_at_ns(incoming.arrived_at.time_since_epoch().count());
  out.set_position_m(incoming.sample.position);
  out.set_velocity_m_per_s(incoming.sample.velocity);
  out.set_force_n(incoming.sample.force);
  put_payload(incoming.sample.payload, out);
}

void put(const LinkHealth& health, std::uint64_t records_dropped, session::LinkStatus& out) {
  out.set_state(to_wire<session::LinkState>(health.state));
  out.set_gap_ns(health.gap.count());
  out.set_round_trip_ns(health.round_trip.count());
  out.set_round_trip_min_ns(health.round_trip_min.count());
  out.set_jitter_ns(health.jitter.count());
  if (health.peer_clock) {
    out.set_clock_offset_ns(health.peer_clock->offset.count());
    out.set_clock_skew(health.peer_clock->skew);
    out.set_clock_uncertainty_ns(health.peer_clock->uncertainty.count());
    out.set_clock_at_ns(health.peer_clock->at.time_since_epoch().count());
  } else {
    out.clear_clock_offset_ns();
    out.set_clock_skew(0);
    out.set_clock_uncertainty_ns(0);
    out.set_clock_at_ns(0);
  }
  out.set_delay_out_ns(health.delay_out.count());
  out.set_delay_in_ns(health.delay_in.count());
  out.set_sent(health.sent);
  out.set_accepted(health.accepted);
  out.set_late(health.late);
  out.set_repaired(health.repaired);
  out.set_lost(health.lost);
  out.set_reordered(health.reordered);
  out.set_stale(health.stale);
  out.set_old_epoch(health.old_epoch);
  out.set_unsent(health.unsent);
  out.set_malformed(health.malformed);
  out.set_foreign(health.foreign);
  out.set_replayed(health.replayed);
  out.set_too_old(health.too_old);
  out.set_forged(health.forged);
  out.set_records_dropped(records_dropped);
}

void put_event(std::uint16_t code, session::Event& out) {
  out.Clear();
  out.set_code(code);
  const std::string_view text = note_text(code);
  out.set_text(text.data(), text.size());
}

void put(const ContactSample& sample, session::ContactSample& out) {
  out.set_tip_m(sample.position);
  out.set_force_n(sample.force);
  out.set_lateral_m(sample.lateral);
  out.set_tip_age_ns(sample.position_age.count());
  out.set_force_age_ns(sample.force_age.count());
}

/// Wraps as the decoder does, so that any two instants come back.
std::int64_t age_ns(TimePoint at, TimePoint then) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(at.time_since_epoch().count()) -
                                   static_cast<std::uint64_t>(then.time_since_epoch().count()));
}

void put(const HandReading& hand, session::HandReading& out) {
  out.set_position_m(hand.position);
  out.set_velocity_m_per_s(hand.velocity);
  out.set_lateral_m(hand.lateral);
  out.set_dead_man_held(hand.pedal_held);
  out.set_emergency_stop(hand.emergency_stop);
  out.set_faulted(hand.faulted);
  out.set_age_ns(age_ns(hand.at, hand.sampled_at));
  out.set_script_phase(hand.script_phase);
}

void put(const StageReading& stage, session::StageReading& out) {
  out.set_position_m(stage.position);
  out.set_velocity_m_per_s(stage.velocity);
  out.set_lateral_m(stage.lateral);
  out.set_at_limit(stage.at_limit);
  out.set_faulted(stage.faulted);
  out.set_age_ns(age_ns(stage.at, stage.sampled_at));
}

void put(const ForceReading& force, session::ForceReading& out) {
  out.set_fresh(force.fresh);
  out.set_force_n(force.force);
  out.set_saturated(force.saturated);
  out.set_age_ns(age_ns(force.at, force.sampled_at));
}

void put(const LinkHeard& heard, session::LinkHeard& out) {
  out.set_state(to_wire<session::LinkState>(heard.state));
  out.set_session_id(heard.session_id);
  out.set_gap_ns(heard.gap.count());
  out.set_round_trip_ns(heard.round_trip.count());
  out.set_key(heard.key);
  out.set_peer_heard(heard.peer_heard);
  out.set_peer_state(to_wire<session::SiteState>(heard.peer_state));
  out.set_peer_epoch(heard.peer_epoch);
  out.set_peer_lateral_m(heard.peer_lateral);
  out.set_depth_number(heard.depth_number);
}

void put(const UserCommand& command, session::UserCommand& out) {
  out.set_emergency_stop(command.emergency_stop);
  out.set_resets(command.resets);
}

void put(const DevicesTold& told, session::Devices& out) {
  out.Clear();
  out.set_of_peer(told.of_peer);
  if (const auto& hand = told.facts.hand) {
    out.mutable_hand()->set_axes(hand->axes);
    out.mutable_hand()->set_force_peak_n(hand->force_peak);
    out.mutable_hand()->set_force_continuous_n(hand->force_continuous);
    out.mutable_hand()->set_rate_hz(hand->rate);
  }
  if (const auto& stage = told.facts.stage) {
    out.mutable_stage()->set_axes(stage->axes);
    out.mutable_stage()->set_travel_min_m(stage->travel_min);
    out.mutable_stage()->set_travel_max_m(stage->travel_max);
    out.mutable_stage()->set_travel_side_m(stage->travel_side);
    out.mutable_stage()->set_speed_m_per_s(stage->speed);
    out.mutable_stage()->set_acceleration_m_per_s2(stage->acceleration);
    out.mutable_stage()->set_rate_hz(stage->rate);
    out.mutable_stage()->set_lag_s(stage->lag);
    out.mutable_stage()->set_drags(stage->drags);
  }
  if (const auto& sensor = told.facts.sensor) {
    out.mutable_sensor()->set_pole_hz(sensor->pole);
    out.mutable_sensor()->set_step_n(sensor->step);
    out.mutable_sensor()->set_range_n(sensor->range);
    out.mutable_sensor()->set_noise_n(sensor->noise);
    out.mutable_sensor()->set_rate_hz(sensor->rate);
    out.mutable_sensor()->set_lag_s(sensor->lag);
  }
}

void put(const DepthEstimate& estimate, session::DepthEstimate& out) {
  out.set_number(estimate.number);
  out.set_stroke_began_at_ns(estimate.stroke_began_at.time_since_epoch().count());
  out.set_stroke_ended_at_ns(estimate.stroke_ended_at.time_since_epoch().count());
  out.set_lateral_m(estimate.lateral);
  out.set_indentation_max_m(estimate.indentation_max);
  out.set_force_max_n(estimate.force_max);
  out.set_surface_m(estimate.surface);
  out.set_verdict(to_wire<session::DepthVerdict>(estimate.verdict));
  out.set_reason(to_wire<session::DepthReason>(estimate.reason));
  out.set_hash_n(estimate.hash);
  out.set_depth_m(estimate.depth);
  out.set_depth_stddev_m(estimate.depth_stddev);
  out.set_depth_low_m(estimate.depth_low);
  out.set_depth_high_m(estimate.depth_high);
  out.set_fit_rms_n(estimate.fit_rms);
}

void put(const DepthReport& report, session::DepthReport& out) {
  out.set_number(report.number);
  out.set_verdict(to_wire<session::DepthVerdict>(report.verdict));
  out.set_reason(to_wire<session::DepthReason>(report.reason));
  out.set_hash_n(report.hash);
  out.set_depth_m(report.depth);
  out.set_depth_stddev_m(report.depth_stddev);
  out.set_depth_low_m(report.depth_low);
  out.set_depth_high_m(report.depth_high);
}

}  // namespace

struct SessionEncoder::Messages {
  explicit Messages(Role role) : site{role} {}

  Prepared ready(Topic topic, TimePoint at, const google::protobuf::MessageLite& message) {
    last = &message;
    return {.topic = topic, .at = at, .size = message.ByteSizeLong()};
  }

  Role site;
  const google::protobuf::MessageLite* last{};  ///< one of the following
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

SessionEncoder::SessionEncoder(Role site) : messages_{std::make_unique<Messages>(site)} {}
SessionEncoder::~SessionEncoder() = default;

std::optional<Prepared> SessionEncoder::prepare(const Record& record,
                                                std::uint64_t records_dropped) {
  using Answer = std::optional<Prepared>;
  Messages& to = *messages_;
  const bool surgeon = to.site == Role::Surgeon;
  const auto plain =
      [&to](Topic topic, TimePoint at, const auto& value, auto& message, bool here = true) {
        if (!here) return Answer{};
        put(value, message);
        return Answer{to.ready(topic, at, message)};
      };
  const auto tick_of = [&to](const SiteTick& tick, auto& message) {
    put_tick(tick, message);
    return Answer{to.ready(Topic::Tick, tick.at, message)};
  };
  const auto event = [&to](TimePoint at) { return Answer{to.ready(Topic::Event, at, to.event)}; };
  return std::visit(
      Overloaded{
          [&](const SiteTick& t) {
            return surgeon ? tick_of(t, to.surgeon_tick) : tick_of(t, to.patient_tick);
          },
          [&](const Arrived& a) { return plain(Topic::Arrived, a.at, a, to.arrived); },
          [&](const LinkStatus& status) {
            put(status.health, records_dropped, to.link);
            return Answer{to.ready(Topic::Link, status.at, to.link)};
          },
          [&](const Note& note) {
            put_event(note.code, to.event);
            to.event.set_detail(note.detail);
            return event(note.at);
          },
          [&](const Transition& transition) {
            put_event(transition.reason, to.event);
            to.event.set_kind(session::Event::TRANSITION);
            to.event.set_from(to_wire<session::SiteState>(transition.from));
            to.event.set_to(to_wire<session::SiteState>(transition.to));
            return event(transition.at);
          },
          [&](const ContactSample& c) {
            return plain(Topic::Contact, c.at, c, to.contact, !surgeon);
          },
          [&](const DepthEstimate& e) {
            return plain(Topic::Depth, e.stroke_ended_at, e, to.estimate, !surgeon);
          },
          [&](const DepthArrived& d) {
            return plain(Topic::Depth, d.at, d.report, to.report, surgeon);
          },
          [&](const HandReading& h) { return plain(Topic::Hand, h.at, h, to.hand, surgeon); },
          [&](const StageReading& s) { return plain(Topic::Stage, s.at, s, to.stage, !surgeon); },
          [&](const ForceReading& f) { return plain(Topic::Force, f.at, f, to.force, !surgeon); },
          [&](const LinkHeard& l) { return plain(Topic::Heard, l.at, l, to.heard); },
          [&](const UserAsked& u) { return plain(Topic::User, u.at, u.command, to.user); },
          [&](const DevicesTold& d) { return plain(Topic::Devices, d.at, d, to.devices); }},
      record);
}

Prepared SessionEncoder::prepare(const TickView& view) {
  Messages& to = *messages_;
  if (to.site == Role::Surgeon) {
    put_view(view, to.surgeon_view);
    return to.ready(Topic::TickView, view.newest.at, to.surgeon_view);
  }
  put_view(view, to.patient_view);
  return to.ready(Topic::TickView, view.newest.at, to.patient_view);
}

void SessionEncoder::store(std::byte* place) const {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): protobuf speaks of uint8_t
  messages_->last->SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(place));
}

}  // namespace palp::record
