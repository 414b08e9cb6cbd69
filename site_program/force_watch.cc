#include "site_program/force_watch.h"

#include <variant>

namespace palp::site_program {

void ForceWatch::take(const Record& record) noexcept {
  if (const auto* tick = std::get_if<SiteTick>(&record)) {
    tip_box_.put({.at = tick->at, .x = tick->place.x, .depth = tick->position});
  } else if (const auto* arrived = std::get_if<Arrived>(&record)) {
    hear(arrived->incoming);
  } else if (const auto* heard = std::get_if<LinkHeard>(&record)) {
    if (heard->session_id != seen_.session_id) {
      seen_ = {.session_id = heard->session_id, .began_at = heard->at};
      standing_ = {};
      measured_ = false;
    }
    seen_.link = heard->state;
    seen_.round_trip = heard->round_trip;
    if (!measured_) seen_.way = heard->round_trip / 2;
  } else if (const auto* status = std::get_if<LinkStatus>(&record)) {
    if (!status->health.peer_clock || status->health.session_id != seen_.session_id) return;
    seen_.peer_ahead = status->health.peer_clock->offset_at(status->at);
    seen_.peer_clock = measured_ = true;
    seen_.way = status->health.delay_in;
  }
}

/// A sample that rode in a later telegram says nothing of its own way.
void ForceWatch::hear(const Incoming& incoming) noexcept {
  if (incoming.repaired || seen_.session_id == 0) return;
  const Duration sent = incoming.sent_at.time_since_epoch();
  const Duration arrived = incoming.arrived_at - seen_.began_at;
  standing_.add(incoming.number, arrived - sent, incoming.arrived_at);
  if (!measured_ && seen_.round_trip > Duration{0}) {
    seen_.peer_ahead = sent + seen_.round_trip / 2 - arrived;
    seen_.peer_clock = true;
  }
  if (incoming.arrived_at - read_at_ >= video::StandingDelay::kStep) {
    read_at_ = incoming.arrived_at;
    seen_.telegrams = standing_.read(incoming.arrived_at);
  }
}

}  // namespace palp::site_program
