#include "lab/run/state_digest.h"

#include <type_traits>

namespace palp::lab {
namespace {

template <class T>
void fold(Digest& digest, const T& value) noexcept {
  if constexpr (std::is_enum_v<T>) {
    digest.add(static_cast<std::underlying_type_t<T>>(value));
  } else if constexpr (requires { value.time_since_epoch(); }) {
    digest.add(value.time_since_epoch().count());
  } else if constexpr (requires { value.count(); }) {
    digest.add(value.count());
  } else {
    digest.add(value);
  }
}

template <class... T>
void fold_all(Digest& digest, const T&... values) noexcept {
  (fold(digest, values), ...);
}

void fold_port(Digest& digest, const PortSample& port) noexcept {
  fold_all(digest, port.position, port.velocity, port.force, port.payload.index());
  if (const auto* wave = std::get_if<WavePayload>(&port.payload)) {
    fold_all(digest, wave->wave_integral, wave->wave_energy);
  } else if (const auto* tdpa = std::get_if<TdpaPayload>(&port.payload)) {
    fold(digest, tdpa->energy_in);
  } else if (const auto* model = std::get_if<ModelPayload>(&port.payload)) {
    fold_all(digest, model->version);
    for (const double c : model->c) fold(digest, c);
    for (const double share : model->relaxing) fold(digest, share);
    fold_all(digest, model->swing, model->swing_quadrature, model->swing_rate);
    fold_all(digest, model->surface, model->depth_max, model->residual);
  }
}

struct RecordFolder {
  Digest& digest;
  void operator()(const SiteTick& t) const noexcept {
    fold_all(digest, t.at, t.state, t.epoch, t.position, t.velocity, t.force, t.lateral, t.command);
    fold_all(digest, t.gate_acted, t.round_trip);
    fold_port(digest, t.sent);
  }
  void operator()(const Arrived& a) const noexcept {
    const Incoming& in = a.incoming;
    fold_all(digest, a.at, in.number, in.fresh, in.repaired, in.sent_at, in.arrived_at);
    fold_port(digest, in.sample);
  }
  void operator()(const LinkStatus& l) const noexcept {
    const LinkHealth& h = l.health;
    fold_all(digest, l.at, h.state, h.gap, h.round_trip, h.sent, h.accepted, h.late, h.lost);
    fold_all(digest, h.repaired, h.stale, h.old_epoch, h.replayed, h.malformed, h.foreign);
  }
  void operator()(const Note& n) const noexcept { fold_all(digest, n.at, n.code, n.detail); }
  void operator()(const Transition& t) const noexcept {
    fold_all(digest, t.at, t.from, t.to, t.reason);
  }
  void operator()(const ContactSample& c) const noexcept {
    fold_all(digest, c.at, c.position, c.force, c.lateral, c.position_age, c.force_age);
  }
  void operator()(const DepthEstimate& d) const noexcept {
    fold_all(digest, d.number, d.stroke_ended_at, d.verdict, d.reason, d.hash, d.depth, d.surface);
  }
  void operator()(const DepthArrived& d) const noexcept {
    fold_all(digest, d.at, d.report.number, d.report.verdict, d.report.depth, d.report.hash);
  }
  void operator()(const record::HandReading& h) const noexcept {
    fold_all(digest, h.at, h.sampled_at, h.position, h.velocity, h.lateral, h.pedal_held);
    fold_all(digest, h.emergency_stop, h.faulted, h.script_phase);
  }
  void operator()(const record::StageReading& s) const noexcept {
    fold_all(digest, s.at, s.sampled_at, s.position, s.velocity, s.lateral, s.at_limit, s.faulted);
  }
  void operator()(const record::ForceReading& f) const noexcept {
    fold_all(digest, f.at, f.fresh, f.sampled_at, f.force, f.saturated);
  }
  void operator()(const record::LinkHeard& l) const noexcept {
    fold_all(digest, l.at, l.state, l.session_id, l.gap, l.round_trip, l.key, l.peer_heard);
    fold_all(digest, l.peer_state, l.peer_epoch, l.peer_lateral, l.depth_number);
  }
  void operator()(const record::UserAsked& u) const noexcept {
    fold_all(digest, u.at, u.command.emergency_stop, u.command.resets);
  }
  void operator()(const record::DevicesTold& d) const noexcept {
    fold_all(digest, d.at, d.of_peer, d.facts.hand.has_value(), d.facts.stage.has_value());
    if (const auto& hand = d.facts.hand) {
      fold_all(digest, hand->axes, hand->force_peak, hand->force_continuous, hand->rate);
    }
    if (const auto& stage = d.facts.stage) {
      fold_all(digest, stage->axes, stage->travel_min, stage->travel_max, stage->travel_side);
      fold_all(digest, stage->speed, stage->acceleration, stage->rate, stage->lag, stage->drags);
    }
    if (const auto& sensor = d.facts.sensor) {
      fold_all(digest, sensor->pole, sensor->step, sensor->range, sensor->noise, sensor->rate);
      fold_all(digest, sensor->lag);
    }
  }
};

}  // namespace

bool DigestRecorder::record(const Record& record) noexcept {
  digest_.add(record.index());
  std::visit(RecordFolder{digest_}, record);
  return next_ == nullptr || next_->record(record);
}

}  // namespace palp::lab
