#include "common/record/session_encoder.h"

#include <set>

#include <google/protobuf/descriptor.pb.h>

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
  out.set_x_m(tick.place.x);
  out.set_y_m(tick.place.y);
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
  out.set_x_m(view.newest.place.x);
  out.set_y_m(view.newest.place.y);
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
  out.set_position_m(sample.position);
  out.set_force_n(sample.force);
  out.set_x_m(sample.place.x);
  out.set_y_m(sample.place.y);
}

void put(const DepthEstimate& estimate, session::DepthEstimate& out) {
  out.set_number(estimate.number);
  out.set_stroke_began_at_ns(estimate.stroke_began_at.time_since_epoch().count());
  out.set_stroke_ended_at_ns(estimate.stroke_ended_at.time_since_epoch().count());
  out.set_x_m(estimate.place.x);
  out.set_y_m(estimate.place.y);
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

/// Copies `type` and what its fields need into `file`, each once.
void add_type(const google::protobuf::Descriptor& type,
              std::set<std::string>& added,
              google::protobuf::FileDescriptorProto& file) {
  if (!added.insert(type.full_name()).second) {
    return;
  }
  type.CopyTo(file.add_message_type());
  for (int k = 0; k < type.field_count(); ++k) {
    const auto& field = *type.field(k);
    if (field.message_type() != nullptr) {
      add_type(*field.message_type(), added, file);
    }
    const auto* enumeration = field.enum_type();
    if (enumeration != nullptr && enumeration->containing_type() == nullptr &&
        added.insert(enumeration->full_name()).second) {
      enumeration->CopyTo(file.add_enum_type());
    }
  }
}

Bytes descriptor_set(const google::protobuf::Descriptor& type) {
  google::protobuf::FileDescriptorSet set;
  auto& file = *set.add_file();
  file.set_name(type.file()->name());
  file.set_package(type.file()->package());
  file.set_syntax("proto3");
  std::set<std::string> added;
  add_type(type, added, file);
  Bytes bytes(set.ByteSizeLong());
  set.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace

std::string_view site_name(Role site) noexcept {
  return site == Role::Surgeon ? "surgeon" : "patient";
}

std::vector<TopicFormat> topics_of(Role site) {
  const bool surgeon = site == Role::Surgeon;
  const std::string prefix{std::string{site_name(site)} + '/'};
  const auto topic = [&](Topic which, const char* name, const google::protobuf::Descriptor* type) {
    return TopicFormat{.topic = which,
                       .name = prefix + name,
                       .schema = type->full_name(),
                       .descriptors = descriptor_set(*type)};
  };
  std::vector<TopicFormat> topics{
      topic(Topic::Tick,
            "tick",
            surgeon ? session::SurgeonTick::descriptor() : session::PatientTick::descriptor()),
      topic(Topic::TickView,
            "tick_view",
            surgeon ? session::SurgeonTickView::descriptor()
                    : session::PatientTickView::descriptor()),
      topic(Topic::Arrived, "arrived", session::ArrivedSample::descriptor()),
      topic(Topic::Link, "link", session::LinkStatus::descriptor()),
      topic(Topic::Event, "event", session::Event::descriptor())};
  if (!surgeon) {
    topics.push_back(topic(Topic::Contact, "contact", session::ContactSample::descriptor()));
  }
  topics.push_back(
      topic(Topic::Depth,
            "depth",
            surgeon ? session::DepthReport::descriptor() : session::DepthEstimate::descriptor()));
  return topics;
}

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
};

SessionEncoder::SessionEncoder(Role site) : messages_{std::make_unique<Messages>(site)} {}
SessionEncoder::~SessionEncoder() = default;

std::optional<Prepared> SessionEncoder::prepare(const Record& record,
                                                std::uint64_t records_dropped) {
  using Answer = std::optional<Prepared>;
  Messages& to = *messages_;
  const bool surgeon = to.site == Role::Surgeon;
  return std::visit(Overloaded{[&](const SiteTick& tick) -> Answer {
                                 if (surgeon) {
                                   put_tick(tick, to.surgeon_tick);
                                   return to.ready(Topic::Tick, tick.at, to.surgeon_tick);
                                 }
                                 put_tick(tick, to.patient_tick);
                                 return to.ready(Topic::Tick, tick.at, to.patient_tick);
                               },
                               [&](const Arrived& arrived) -> Answer {
                                 put(arrived, to.arrived);
                                 return to.ready(Topic::Arrived, arrived.at, to.arrived);
                               },
                               [&](const LinkStatus& status) -> Answer {
                                 put(status.health, records_dropped, to.link);
                                 return to.ready(Topic::Link, status.at, to.link);
                               },
                               [&](const Note& note) -> Answer {
                                 put_event(note.code, to.event);
                                 to.event.set_detail(note.detail);
                                 return to.ready(Topic::Event, note.at, to.event);
                               },
                               [&](const Transition& transition) -> Answer {
                                 put_event(transition.reason, to.event);
                                 to.event.set_kind(session::Event::TRANSITION);
                                 to.event.set_from(to_wire<session::SiteState>(transition.from));
                                 to.event.set_to(to_wire<session::SiteState>(transition.to));
                                 return to.ready(Topic::Event, transition.at, to.event);
                               },
                               [&](const ContactSample& sample) -> Answer {
                                 if (surgeon) {
                                   return std::nullopt;
                                 }
                                 put(sample, to.contact);
                                 return to.ready(Topic::Contact, sample.at, to.contact);
                               },
                               [&](const DepthEstimate& estimate) -> Answer {
                                 if (surgeon) {
                                   return std::nullopt;
                                 }
                                 put(estimate, to.estimate);
                                 return to.ready(
                                     Topic::Depth, estimate.stroke_ended_at, to.estimate);
                               },
                               [&](const DepthArrived& arrived) -> Answer {
                                 if (!surgeon) {
                                   return std::nullopt;
                                 }
                                 put(arrived.report, to.report);
                                 return to.ready(Topic::Depth, arrived.at, to.report);
                               }},
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
