#include "common/link/link.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/core/check.h"
#include "common/message/warm_up_telegrams.h"
#include "common/message/wire_bytes.h"

namespace palp::link {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

/// How far apart the repeated samples lie: single losses and the bursts of a few milliseconds that
/// radio links show are both bridged, where repeating the last two samples helps against single
/// losses only.
constexpr Duration kOlderDistance = milliseconds{5};
constexpr Duration kPeriodMin = microseconds{200};
constexpr Duration kPeriodMax = milliseconds{100};

std::uint64_t distance_in_numbers(Duration period) {
  if (period < kPeriodMin || period > kPeriodMax) {
    throw std::invalid_argument("link period is " + std::to_string(seconds(period) * 1e3) +
                                " ms, must be 0.2 to 100 ms");
  }
  return static_cast<std::uint64_t>(
      std::max<Duration::rep>(1, (kOlderDistance + period / 2) / period));
}

std::uint64_t nanoseconds_since(TimePoint start, TimePoint at) noexcept {
  return static_cast<std::uint64_t>(std::max<Duration::rep>(0, (at - start).count()));
}

Duration as_duration(std::uint64_t wire_ns) noexcept {
  return nanoseconds{static_cast<Duration::rep>(wire_ns)};
}

/// Whole microseconds, rounded: a truncated hold would lengthen every round trip by half of one.
std::uint32_t hold_us(Duration hold) noexcept {
  const auto rounded = (std::max(hold, Duration{0}) + nanoseconds{500}) / microseconds{1};
  return static_cast<std::uint32_t>(std::min<Duration::rep>(rounded, message::kHoldMaxUs));
}

}  // namespace

Link::Link(const LinkConfig& config, std::unique_ptr<Codec> codec)
    : config_{config},
      older_distance_{distance_in_numbers(config.period)},
      codec_{std::move(codec)} {
  PALP_CHECK(codec_ != nullptr, "a link needs a codec");
  PALP_CHECK(kOlder * older_distance_ < kHistory, "the history reaches back far enough");
  samples_.reserve(kDatagramsPerTickMax * kSamplesPerTelegram);
}

void Link::end_session() noexcept {
  counters_.lost += session_state_.received.missing();
  session_state_ = SessionState{};
  session_id_ = 0;
  peer_devices_ = {};
}

LinkUpdate Link::adopt(LinkUpdate next, TimePoint now) noexcept {
  // Its numbers would start at 0 again, under keys that have sealed such numbers.
  if (next.continues && next.session_id != session_id_) return next;
  LinkUpdate retired{.transport = nullptr,
                     .protection = nullptr,
                     .send_connection = send_connection_,
                     .receive_connection = receive_connection_,
                     .session_id = session_id_};
  if (next.session_id == 0) {
    end_session();
    retired.transport = std::exchange(transport_, nullptr);
    retired.protection = std::exchange(protection_, nullptr);
    return retired;
  }
  if (next.session_id != session_id_) {
    PALP_CHECK(next.protection != nullptr, "a new session has its own protection");
    end_session();
    session_id_ = next.session_id;
    peer_devices_ = next.peer_devices;
    session_state_.began_at = now;
  }
  if (next.transport) retired.transport = std::exchange(transport_, std::move(next.transport));
  if (next.protection) retired.protection = std::exchange(protection_, std::move(next.protection));
  PALP_CHECK(transport_ != nullptr, "a session has a transport");
  send_connection_ = next.send_connection;
  receive_connection_ = next.receive_connection;
  return retired;
}

void Link::attach_older(WireTelegram& wire, TimePoint now) const noexcept {
  const std::uint64_t number = session_state_.next_number;
  for (std::size_t i = 0; i < kOlder; ++i) {
    const std::uint64_t distance = older_distance_ * (i + 1);
    if (number < distance) return;
    const Sent& sent = session_state_.history[(number - distance) % kHistory];
    if (!sent.used || sent.number != number - distance) return;
    // Its receiver derives the send time from ours, and books it under our epoch.
    if (sent.epoch != wire.telegram.site.epoch) return;
    const Duration expected = config_.period * static_cast<Duration::rep>(distance);
    if (std::chrono::abs(now - sent.at - expected) > config_.period / 2) return;
    wire.older[i] = sent.sample;
    ++wire.older_count;
  }
}

WireTelegram Link::compose(const Telegram& telegram, TimePoint now) const noexcept {
  const SessionState& state = session_state_;
  WireTelegram wire;
  wire.sent_at_ns = nanoseconds_since(state.began_at, now);
  if (state.heard) {
    wire.echo_ns = state.newest_sent_at_ns;
    wire.hold_us = hold_us(now - state.newest_arrived_at);
    wire.newest_number = state.received.newest();
    wire.before_newest = state.received.before_newest();
  }
  wire.telegram = telegram;
  attach_older(wire, now);
  return wire;
}

void Link::send(const Telegram& telegram, TimePoint now) noexcept {
  if (session_id_ == 0) return;
  SessionState& state = session_state_;
  const WireTelegram wire = compose(telegram, now);
  const std::size_t size =
      codec_->encode(wire, std::span{plain_}.first<message::kTelegramSizeMax>());
  if (size == 0) {  // a node that says what no peer would take
    ++counters_.unsent;
    return;
  }
  const Header header{.type = PacketType::Data,
                      .key = 0,
                      .length = 0,
                      .connection = send_connection_,
                      .number = state.next_number};
  const std::size_t sealed = protection_->seal(header, std::span{plain_}.first(size), datagram_);
  if (sealed == 0) {  // the keys are used up: their replacement has failed for days
    ++counters_.unsent;
    return;
  }
  if (!transport_->send(std::span{datagram_}.first(sealed), now)) ++counters_.unsent;
  // What follows may take its time: the telegram is on its way.
  const std::uint32_t epoch = telegram.site.epoch;
  state.history[header.number % kHistory] = {
      true, header.number, epoch, now, message::for_repetition(telegram.port)};
  state.epoch_sent = std::max(state.epoch_sent, epoch);
  state.note_payload(telegram.port);
  ++state.next_number;
  ++counters_.sent;
  note_ways(now);
}

Arrivals Link::receive(TimePoint now) noexcept {
  note_ways(now);  // of the last tick, if nothing was sent in it
  samples_.clear();
  accepted_now_ = 0;
  if (transport_) drain(now);
  if (session_id_ != 0) {
    if (gap(now) > config_.closed_after) {
      end_session();
      samples_.clear();  // what waited for so long belongs to no session any more
    } else {
      synchronise(now);
    }
  }
  const auto by_number = [](const Incoming& a, const Incoming& b) { return a.number < b.number; };
  if (!std::is_sorted(samples_.begin(), samples_.end(), by_number)) {
    std::sort(samples_.begin(), samples_.end(), by_number);
  }
  for (const Incoming& incoming : samples_) counters_.repaired += incoming.repaired ? 1 : 0;
  return {.samples = samples_,
          .peer = session_state_.peer,
          .peer_heard = session_state_.heard,
          .accepted = accepted_now_};
}

/// Also without a session: whoever reads control messages off the same transport depends on it.
void Link::drain(TimePoint now) noexcept {
  for (std::size_t i = 0; i < kDatagramsPerTickMax; ++i) {
    const std::optional<Datagram> received = transport_->receive(datagram_, now);
    if (!received) return;
    if (received->size > datagram_.size()) {  // was cut off
      count(Rejection::Malformed);
      continue;
    }
    const auto opened = open(std::span{datagram_}.first(received->size), now);
    if (!opened) {
      count(opened.error());
      continue;
    }
    // From here on the datagram is authentic.
    session_state_.received.mark(opened->number);
    if (session_state_.received.newest() > opened->number) {
      ++counters_.reordered;
    } else {
      session_state_.newest_key = opened->key;
    }
    const auto wire = codec_->decode(std::span{plain_}.first(opened->size));
    if (!wire) {
      count(Rejection::Malformed);
      continue;
    }
    take(*wire, opened->number, std::min(received->arrived_at, now));
  }
}

tl::expected<Link::Opened, Rejection> Link::open(std::span<const std::byte> datagram,
                                                 TimePoint now) noexcept {
  if (session_id_ == 0) {
    return tl::unexpected(parse_clear_part(datagram) ? Rejection::Foreign : Rejection::Malformed);
  }
  const auto header = protection_->read_header(datagram);
  if (!header) return tl::unexpected(header.error());
  if (header->type != PacketType::Data || header->connection != receive_connection_) {
    return tl::unexpected(Rejection::Foreign);
  }
  transport_->recognised(now);
  switch (session_state_.received.judge(header->number)) {
    case ReplayWindow::Verdict::Seen:
      return tl::unexpected(Rejection::Replayed);
    case ReplayWindow::Verdict::TooOld:
      return tl::unexpected(Rejection::TooOld);
    case ReplayWindow::Verdict::New:
      break;
  }
  const auto size = protection_->open(*header, datagram, plain_);
  if (!size) return tl::unexpected(size.error());
  return Opened{header->number, header->key, *size};
}

void Link::count(Rejection rejection) noexcept {
  // In the order of Rejection.
  constexpr std::array kCounters{&LinkHealth::malformed,
                                 &LinkHealth::foreign,
                                 &LinkHealth::replayed,
                                 &LinkHealth::too_old,
                                 &LinkHealth::forged};
  ++(counters_.*kCounters[static_cast<std::size_t>(rejection)]);
}

void Link::take(const WireTelegram& wire, std::uint64_t number, TimePoint arrived_at) noexcept {
  SessionState& state = session_state_;
  const Duration sent_at = as_duration(wire.sent_at_ns);
  const Duration excess =
      state.clock.add_one_way(arrived_at - state.began_at - sent_at, arrived_at);
  const bool newer = !state.heard || number > state.newest_number;
  if (newer) {
    const Duration limit = std::max(config_.stale_after, state.clock.least(arrived_at) / 2);
    if (excess > limit) {
      ++counters_.stale;
      return;
    }
    accept(wire, number, arrived_at);
  } else {
    ++counters_.late;
  }

  const std::uint32_t epoch = wire.telegram.site.epoch;
  hand_over({.sample = wire.telegram.port,
             .number = number,
             .fresh = newer,
             .repaired = false,
             .sent_at = PeerTimePoint{sent_at},
             .arrived_at = arrived_at},
            epoch);
  for (std::size_t i = 0; i < wire.older_count; ++i) {
    const std::uint64_t distance = older_distance_ * (i + 1);
    if (number < distance) return;
    const Duration earlier = config_.period * static_cast<Duration::rep>(distance);
    hand_over({.sample = wire.older[i],
               .number = number - distance,
               .fresh = false,
               .repaired = true,
               .sent_at = PeerTimePoint{sent_at - earlier},
               .arrived_at = arrived_at},
              epoch);
  }
}

void Link::accept(const WireTelegram& wire, std::uint64_t number, TimePoint arrived_at) noexcept {
  SessionState& state = session_state_;
  ++counters_.accepted;
  ++accepted_now_;
  if (!state.heard) state.first_accepted_at = arrived_at;
  state.heard = true;
  state.newest_number = number;
  state.newest_sent_at_ns = wire.sent_at_ns;
  state.newest_arrived_at = arrived_at;

  const std::uint32_t wanted_before = epoch_wanted();
  const SiteReport before = std::exchange(state.peer, wire.telegram.site);
  if (accepted_now_ > 1) {  // what not every telegram says is not lost where several come at once
    if (state.peer.map.number == 0) state.peer.map = before.map;
    if (state.peer.map_cell.number == 0) state.peer.map_cell = before.map_cell;
  }
  state.note_payload(wire.telegram.port);
  if (epoch_wanted() > wanted_before) {  // what came just before belongs to a finished account
    counters_.old_epoch += samples_.size();
    samples_.clear();
  }

  const Duration sent_at = as_duration(wire.sent_at_ns);
  state.ways.here = {arrived_at - state.began_at - sent_at, sent_at, arrived_at};
  if (wire.echo_ns == message::kNothingHeard) return;
  const TimePoint echo = state.began_at + as_duration(wire.echo_ns);
  const microseconds hold{wire.hold_us};
  if (!state.clock.add_round_trip(echo, hold, arrived_at)) return;
  if (state.echo_ns != message::kNothingHeard && wire.echo_ns <= state.echo_ns) return;
  state.echo_ns = wire.echo_ns;
  ++state.exchanges;
  WaysTaken& ways = state.ways;
  if (ways.count == WaysTaken::kMax) return;
  ways.there[ways.count++] = {sent_at - hold - as_duration(wire.echo_ns), sent_at, arrived_at};
}

/// The peer's echo tells of the newest telegram that it had in a tick; of ours it is the same.
void Link::note_ways(TimePoint now) noexcept {
  WaysTaken& ways = session_state_.ways;
  for (const WayTaken& one : std::span{ways.there}.first(ways.count)) {
    session_state_.offset.add_there(one.way, one.tick, one.arrived_at);
  }
  if (ways.here) session_state_.offset.add_here(ways.here->way, now, ways.here->arrived_at);
  ways.count = 0;
  ways.here.reset();
}

/// The newest epoch that either side is known to be in.
std::uint32_t Link::epoch_wanted() const noexcept {
  return std::max(session_state_.epoch_sent, session_state_.heard ? session_state_.peer.epoch : 0);
}

void Link::hand_over(const Incoming& incoming, std::uint32_t epoch) noexcept {
  if (session_state_.handed_over.judge(incoming.number) != ReplayWindow::Verdict::New) return;
  session_state_.handed_over.mark(incoming.number);
  if (epoch < epoch_wanted()) {
    ++counters_.old_epoch;
    return;
  }
  samples_.push_back(incoming);
}

void Link::synchronise(TimePoint now) noexcept {
  SessionState& state = session_state_;
  if (state.synchronised || !state.clock.measured()) return;
  if (state.clock.least(now) > config_.round_trip_max) return;
  state.synchronised = state.exchanges >= config_.sync_exchanges ||
                       now - state.first_accepted_at >= config_.sync_time;
}

Duration Link::gap(TimePoint now) const noexcept {
  if (session_id_ == 0) return Duration{0};
  const SessionState& state = session_state_;
  return std::max(Duration{0}, now - (state.heard ? state.newest_arrived_at : state.began_at));
}

void Link::warm_up() noexcept {
  if (session_id_ == 0) return;
  transport_->warm_up();
  // What the next one repeats and acknowledges has to come into the caches as well.
  const Sent& last = session_state_.history[(session_state_.next_number + kHistory - 1) % kHistory];
  Telegram telegram = message::warm_up_telegrams()[session_state_.payload_kind];
  telegram.site.epoch = last.epoch;
  const WireTelegram wire = compose(telegram, last.at + config_.period);
  const std::size_t size =
      codec_->encode(wire, std::span{plain_}.first<message::kTelegramSizeMax>());
  protection_->warm_up(std::span{plain_}.first(size), datagram_);
  (void)codec_->decode(std::span{plain_}.first(size));
}

LinkState Link::judge(TimePoint now) const noexcept {
  if (session_id_ == 0 || !session_state_.synchronised) return LinkState::Down;
  if (gap(now) > config_.closed_after) return LinkState::Down;
  return judge_gap(config_.watchdog, gap(now));
}

LinkHealth Link::health(TimePoint now) const noexcept {
  LinkHealth health = counters_;
  health.state = judge(now);
  health.session_id = session_id_;
  health.gap = gap(now);
  health.newest_number = session_state_.received.newest();
  health.key = session_state_.newest_key;
  health.round_trip = session_state_.clock.smoothed();
  health.round_trip_min = session_state_.clock.least(now);
  health.jitter = session_state_.clock.deviation();
  health.peer_clock = session_state_.offset.estimate();
  health.delay_out = session_state_.offset.delay_out();
  health.delay_in = session_state_.offset.delay_in();
  health.lost += session_state_.received.missing();
  return health;
}

}  // namespace palp::link
