#include "monitor/feed.h"

#include <utility>
#include <variant>

#include "common/record/notes.h"

namespace palp::monitor {
namespace {

using record::NoteCode;

/// Whether an engagement was refused by this note.
bool is_refusal(std::uint16_t code) noexcept {
  return code == static_cast<std::uint16_t>(NoteCode::RoundTripTooLong) ||
         code == static_cast<std::uint16_t>(NoteCode::EngageRefusedForce);
}

/// Of these every one goes to the screen; what comes at 1 kHz is in the file alone.
bool is_slow(const Record& record) noexcept {
  return std::holds_alternative<LinkStatus>(record) || std::holds_alternative<Note>(record) ||
         std::holds_alternative<Transition>(record) ||
         std::holds_alternative<DepthEstimate>(record) ||
         std::holds_alternative<DepthArrived>(record) ||
         std::holds_alternative<MapEstimate>(record) ||
         std::holds_alternative<MapArrived>(record) || std::holds_alternative<MapCell>(record);
}

}  // namespace

Feed::Feed(link::Role site, const record::WallClock& clock, Duration period)
    : site_{site}, clock_{clock}, period_{period}, encoder_{site} {}

void Feed::take(const Record& record) noexcept {
  if (const auto* tick = std::get_if<SiteTick>(&record)) {
    count(*tick);
    view(*tick);
  } else if (const auto* arrived = std::get_if<Arrived>(&record)) {
    hear(arrived->incoming);
  } else if (const auto* heard = std::get_if<LinkHeard>(&record)) {
    now_.heard = *heard;
  } else if (const auto* change = std::get_if<Transition>(&record)) {
    now_.reason = change->reason;
    if (change->to == SiteState::Engaged) now_.refused = 0;
  } else if (const auto* note = std::get_if<Note>(&record)) {
    if (is_refusal(note->code)) now_.refused = note->code;
  }
  if (!is_slow(record)) return;
  if (const auto prepared = encoder_.prepare(record, now_.dropped)) put(*prepared);
}

/// What comes late or once more is for the file.
void Feed::hear(const Incoming& incoming) noexcept {
  if (!incoming.fresh) return;
  now_.peer_sampled = true;
  now_.peer_position = incoming.sample.position;
  peer_force_.add(incoming.sample.force, std::exchange(peer_told_, false));
}

void Feed::tell(bool recording) noexcept {
  if (now_.ticks == 0) return;
  now_.stamp = clock_.stamp(now_.tick.at);
  now_.recording = recording;
  now_.peer_force = peer_force_.newest;
  now_.peer_force_min = peer_told_ ? peer_force_.newest : peer_force_.min;
  now_.peer_force_max = peer_told_ ? peer_force_.newest : peer_force_.max;
  peer_told_ = true;
  status_.put(now_);
}

void Feed::count(const SiteTick& tick) noexcept {
  if (now_.ticks > 0) {
    const auto periods = (elapsed(now_.tick.at, tick.at) + period_ / 2) / period_;
    if (periods > 1) now_.ticks_missed += static_cast<std::uint64_t>(periods - 1);
  }
  ++now_.ticks;
  now_.tick = tick;
}

/// As the session's writer cuts them: the same views, the same bytes.
void Feed::view(const SiteTick& tick) noexcept {
  if (view_.ticks > 0 && elapsed(view_.began_at, tick.at) >= kViewInterval) {
    put(encoder_.prepare(view_));
    view_ = {};
  }
  view_.add(tick);
}

void Feed::put(const record::Prepared& prepared) noexcept {
  message_.topic = prepared.topic;
  message_.stamp = clock_.stamp(prepared.at);
  message_.size = static_cast<std::uint16_t>(prepared.size);
  encoder_.store(message_.bytes.data());
  if (!queue_.try_enqueue(message_)) ++now_.dropped;
}

}  // namespace palp::monitor
