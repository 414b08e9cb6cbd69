#include "common/record/site_account.h"

#include <algorithm>

#include "common/core/check.h"
#include "common/message/port_limits.h"

namespace palp::record {

SiteAccount::SiteAccount(const SiteAccountConfig& config, Recorder& recorder) noexcept
    : config_{config}, recorder_{recorder} {
  PALP_CHECK(config.period > Duration{0}, "a period takes time");
}

Lapse SiteAccount::begin_tick(TimePoint now) noexcept {
  std::int64_t periods = 1;
  if (counts_.ticks > 0) {
    periods = std::max<std::int64_t>(1, (now - now_ + config_.period / 2) / config_.period);
  }
  now_ = now;
  ++counts_.ticks;
  counts_.ticks_missed += static_cast<std::uint64_t>(periods - 1);
  return {config_.period, periods};
}

PortSample SiteAccount::within_limits(PortSample sample) noexcept {
  if (message::keep_limits(sample)) ++counts_.samples_limited;
  return sample;
}

void SiteAccount::record(const Record& record) noexcept {
  ++(recorder_.record(record) ? counts_.records : counts_.records_lost);
}

void SiteAccount::note(NoteCode code, double detail) noexcept {
  record(Note{now_, static_cast<std::uint16_t>(code), detail});
}

void SiteAccount::transition(SiteState from, SiteState to, NoteCode reason) noexcept {
  if (reason == NoteCode::None) return;
  record(Transition{now_, from, to, static_cast<std::uint16_t>(reason)});
}

void SiteAccount::arrived(const link::Arrivals& arrivals) noexcept {
  for (const Incoming& incoming : arrivals.samples) record(Arrived{now_, incoming});
}

void SiteAccount::link(const LinkHealth& health) noexcept {
  link_events_.look(health, [this](NoteCode code, double detail) { note(code, detail); });
  if (link_recorded_at_ && now_ - *link_recorded_at_ < config_.link_status_every) return;
  link_recorded_at_ = now_;
  record(LinkStatus{now_, health});
}

void SiteAccount::devices(const DeviceFacts& own,
                          const DeviceFacts& peer,
                          bool peer_changed) noexcept {
  if (first_tick()) record(DevicesTold{.at = now_, .of_peer = false, .facts = own});
  if (peer_changed) record(DevicesTold{.at = now_, .of_peer = true, .facts = peer});
}

void SiteAccount::user(const UserCommand& command) noexcept {
  const bool same =
      command.emergency_stop == user_.emergency_stop && command.resets == user_.resets;
  if (same && !first_tick()) return;
  user_ = command;
  record(UserAsked{now_, command});
}

void SiteAccount::heard(const LinkHealth& health,
                        const link::Arrivals& arrivals,
                        std::uint32_t depth_number) noexcept {
  record(LinkHeard{.at = now_,
                   .state = health.state,
                   .session_id = health.session_id,
                   .gap = health.gap,
                   .round_trip = health.round_trip,
                   .key = health.key,
                   .peer_heard = arrivals.peer_heard,
                   .peer_state = arrivals.peer.state,
                   .peer_epoch = arrivals.peer.epoch,
                   .peer_place = arrivals.peer.place,
                   .depth_number = depth_number});
}

}  // namespace palp::record
