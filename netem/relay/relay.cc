#include "netem/relay/relay.h"

#include <algorithm>

#include <poll.h>
#include <time.h>

#include "common/io/net/media_wait.h"
#include "common/io/realtime/realtime.h"

namespace palp::netem {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// After so long a rest the caches have forgotten how to send: 50 us instead of 8.
constexpr Duration kCold = milliseconds{1};
constexpr Duration kLate = microseconds{60};
/// A SCHED_FIFO thread that is awake for 95 % of a second is stopped for the rest of it by the
/// kernel: under a flood it naps before.
constexpr Duration kAwakeMax = microseconds{2000};
constexpr Duration kNap = microseconds{120};
/// Batches of one drain: bounds the time the other socket and the releases wait.
constexpr int kBatchesPerDrain = 4;
constexpr Duration kShowEvery = milliseconds{250};
/// Commands from outside are looked for at least so often.
constexpr Duration kRestMax = milliseconds{10};

timespec to_timespec(Duration span) noexcept {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(span);
  return {.tv_sec = whole.count(), .tv_nsec = (span - whole).count()};
}

bool looks_like_video(std::span<const std::byte> datagram) noexcept {
  return !datagram.empty() && datagram[0] == io::kMediaFirstByte;
}

}  // namespace

Relay::Relay(const RelayConfig& config)
    : client_side_{DatagramSocket::bound(config.listen, config.datagram_max)},
      server_side_{DatagramSocket::connected(config.forward, config.datagram_max),
                   DatagramSocket::connected(config.forward, config.datagram_max)},
      forward_{config.forward},
      client_end_{client_side_.local()},
      server_ends_{CapturedEnd{server_side_[kForce].local()},
                   CapturedEnd{server_side_[kVideo].local()}},
      start_{monotonic_now()},
      up_{config.up, config.seed, Direction::Up, config.in_flight_max, start_, config.datagram_max},
      down_{config.down,
            config.seed,
            Direction::Down,
            config.in_flight_max,
            start_,
            config.datagram_max},
      stop_descriptor_{config.stop_descriptor},
      priority_{config.priority},
      timing_{start_} {
  waiting_.reserve(64);
}

bool Relay::serve(Duration span) {
  if (priority_ > 0) {
    real_time_ = io::request_realtime(priority_, false, io::read_realtime_limits()).priority > 0;
    priority_ = 0;
  }
  const TimePoint until = monotonic_now() + span;
  Readable readable{.client_side = true, .server_side = true};
  for (;;) {
    recording_on_ = recording.wanted.load(std::memory_order_acquire);
    take_commands(monotonic_now());
    drain(readable);
    const TimePoint now = monotonic_now();
    tell_laws(now);
    release(Direction::Up, now);
    release(Direction::Down, now);
    rebind_if_asked();
    if (stopped_) return false;
    if (now >= until) return true;
    if (now >= show_at_) show(now);
    readable = rest(now, until);
  }
}

RelayTraffic Relay::traffic(Direction direction) const {
  RelayTraffic traffic = traffic_[static_cast<std::size_t>(direction)];
  traffic.socket_errors = socket_errors(direction);
  return traffic;
}

void Relay::drain(Readable readable) noexcept {
  for (int batch = 0; readable.client_side && batch < kBatchesPerDrain; ++batch) {
    const auto datagrams = client_side_.receive();
    if (datagrams.empty()) break;
    for (std::size_t i = 0; i < datagrams.size(); ++i) {
      const ReceivedDatagram& one = datagrams[i];
      const io::Endpoint from = client_side_.sender_of(i);
      const bool beside = looks_like_video(one.bytes) && client() && !(from == *client());
      clients_[beside ? kVideo : kForce].heard(from, one.bytes, one.arrived_at);
    }
    push(Direction::Up, datagrams);
    if (datagrams.size() < kDatagramBatch) break;
  }
  for (DatagramSocket& socket : server_side_) {
    for (int batch = 0; readable.server_side && batch < kBatchesPerDrain; ++batch) {
      const auto datagrams = socket.receive();
      push(Direction::Down, datagrams);
      if (datagrams.size() < kDatagramBatch) break;
    }
  }
}

void Relay::push(Direction direction, std::span<const ReceivedDatagram> datagrams) noexcept {
  Channel& channel = way(direction);
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    const ReceivedDatagram& datagram = datagrams[i];
    const auto decisions = channel.push(datagram.bytes, datagram.arrived_at, datagram.tos);
    if (!recording_on_) continue;
    recording.decided(decisions, direction);
    Crossing from = crossing(direction == Direction::Up ? 0 : 1, lane_of(datagram.bytes));
    // Not always the client: a capture tells who it was.
    if (direction == Direction::Up) from.peer = CapturedEnd{client_side_.sender_of(i)};
    recording.crossed(from, datagram.bytes, datagram.arrived_at, false, datagram.tos);
  }
}

/// Another protocol's datagrams may begin so too: there is no second client then.
std::size_t Relay::lane_of(std::span<const std::byte> datagram) const noexcept {
  return looks_like_video(datagram) && clients_[kVideo].client() ? kVideo : kForce;
}

Crossing Relay::crossing(std::uint8_t side, std::size_t lane) const noexcept {
  const CapturedEnd peer{side == 1 ? forward_ : clients_[lane].client().value_or(io::Endpoint{})};
  return {.own = side == 1 ? server_ends_[lane] : client_end_, .peer = peer, .side = side};
}

std::uint64_t Relay::socket_errors(Direction direction) const noexcept {
  if (direction == Direction::Down) return client_side_.errors();
  return server_side_[kForce].errors() + server_side_[kVideo].errors();
}

/// Changes whose time has come act on what arrives from now on.
void Relay::take_commands(TimePoint now) {
  RelayCommand command;
  while (waiting_.size() < waiting_.capacity() && commands.try_dequeue(command)) {
    waiting_.push_back(std::move(command));
  }
  for (std::size_t i = 0; i < waiting_.size();) {
    if (waiting_[i].at > now) {
      ++i;
      continue;
    }
    way(waiting_[i].direction).apply(waiting_[i].change, now);
    waiting_[i].at = now;
    tell_laws(now);
    // What the change replaced is freed by the other thread, or here if it does not keep up.
    (void)spent.try_enqueue(std::move(waiting_[i]));
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void Relay::tell_laws(TimePoint now) noexcept {
  law_numbers[0].store(up_.impaired_path().law_number(now), std::memory_order_relaxed);
  law_numbers[1].store(down_.impaired_path().law_number(now), std::memory_order_relaxed);
}

Duration Relay::lead(Direction direction, TimePoint next) const noexcept {
  const TimePoint until = next + timing_.lead(1);
  return timing_.lead(channel(direction).impaired_path().in_line_by(until, kDatagramBatch));
}

/// Sends what is due, in batches: their bytes stay where they are until the next push.
void Relay::release(Direction direction, TimePoint now) noexcept {
  Channel& channel = way(direction);
  TimePoint before = now;
  for (auto next = channel.next_release(); next; next = channel.next_release()) {
    const TimePoint due = before + lead(direction, *next);
    std::size_t count = 0;
    while (count < kDatagramBatch) {
      const auto popped = channel.pop_in_place(due);
      if (!popped) break;
      batch_.leaving[count] = popped->decision;
      batch_.outgoing[count] = {popped->bytes, popped->decision.tos};
      ++count;
    }
    if (count == 0) return;
    const std::size_t sent = send(direction, count);
    traffic_[static_cast<std::size_t>(direction)].unsent += count - sent;
    account(direction, sent, before);
    for (std::size_t i = 0; recording_on_ && i < count; ++i) {
      if (batch_.leaving[i].open) recording.left(batch_.leaving[i], direction);
      if (i >= sent) continue;
      const OutgoingDatagram& one = batch_.outgoing[i];
      const std::uint8_t side = direction == Direction::Up ? 1 : 0;
      recording.crossed(
          crossing(side, lane_of(one.bytes)), one.bytes, monotonic_now(), true, one.tos);
    }
    if (count < kDatagramBatch) return;
    before = monotonic_now();
  }
}

/// The first `count` of the batch, with a call for each stretch of the same kind.
std::size_t Relay::send(Direction direction, std::size_t count) noexcept {
  std::size_t sent = 0;
  for (std::size_t from = 0, end = 0; from < count; from = end) {
    const std::size_t lane = lane_of(batch_.outgoing[from].bytes);
    for (end = from + 1; end < count && lane_of(batch_.outgoing[end].bytes) == lane;) ++end;
    const std::span stretch = std::span{batch_.outgoing}.subspan(from, end - from);
    if (direction == Direction::Up) {
      sent += server_side_[lane].send(stretch, nullptr);
    } else if (const auto& to = clients_[lane].client()) {
      sent += client_side_.send(stretch, &*to);
    }
  }
  return sent;
}

void Relay::account(Direction direction, std::size_t sent, TimePoint before) noexcept {
  if (sent == 0) return;
  RelayTraffic& traffic = traffic_[static_cast<std::size_t>(direction)];
  const TimePoint after = monotonic_now();
  traffic.forwarded += sent;
  const Duration each = (after - before) / static_cast<std::int64_t>(sent);
  for (std::size_t i = 0; i < sent; ++i) {
    const TimePoint left = before + each * static_cast<std::int64_t>(i + 1);
    traffic.delay.record(left - batch_.leaving[i].arrived_at);
    const Duration late = left - batch_.leaving[i].released_at;
    traffic.release_error.record(late < Duration{} ? -late : late);
    if (late > kLate) ++traffic.late_releases;
  }
  timing_.sent(each);
}

/// As a router that forgets a mapping: the server sees another port, and what it sends to the old
/// one is lost.
void Relay::rebind_if_asked() {
  const std::uint64_t asked = up_.impaired_path().rebinds() + down_.impaired_path().rebinds();
  if (asked == rebinds_) return;
  rebinds_ = asked;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    server_side_[lane].reconnect(forward_);
    server_ends_[lane] = CapturedEnd{server_side_[lane].local()};
  }
}

/// Waits in the kernel until something arrives or shortly before the next release; then it looks
/// without waiting, which is the spin.
Relay::Readable Relay::rest(TimePoint now, TimePoint until) noexcept {
  TimePoint next = std::min(until, now + kRestMax);
  for (const Direction direction : {Direction::Up, Direction::Down}) {
    const auto release = way(direction).next_release();
    if (release) next = std::min(next, *release - lead(direction, *release));
  }
  if (real_time_ && timing_.awake(now) > kAwakeMax) {
    const timespec nap = to_timespec(kNap);
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &nap, nullptr);
    timing_.slept(monotonic_now());
    return {.client_side = true, .server_side = true};
  }
  std::array<pollfd, 4> watched{{{client_side_.descriptor(), POLLIN, 0},
                                 {server_side_[kForce].descriptor(), POLLIN, 0},
                                 {server_side_[kVideo].descriptor(), POLLIN, 0},
                                 {stop_descriptor_, POLLIN, 0}}};
  const TimePoint wake = std::max(next - timing_.spin(), now);
  const timespec wait = to_timespec(wake - now);
  const int ready = ::ppoll(watched.data(), watched.size(), &wait, nullptr);
  const bool slept = wait.tv_sec > 0 || wait.tv_nsec > 0;
  if (slept) {
    const TimePoint woken = monotonic_now();
    if (woken - now > kNap / 4) timing_.slept(woken);
    if (ready == 0 && woken - now > kCold) warm();
    if (ready == 0) timing_.woken(monotonic_now() - wake);
  }
  if (ready <= 0) return {};
  stopped_ = (watched[3].revents & POLLIN) != 0;
  return {.client_side = watched[0].revents != 0,
          .server_side = watched[1].revents != 0 || watched[2].revents != 0};
}

/// Both ways: which of them is next may change till then.
void Relay::warm() noexcept {
  if (up_.next_release()) server_side_[kForce].warm(nullptr);
  if (down_.next_release() && client()) client_side_.warm(&*client());
}

void Relay::show(TimePoint now) noexcept {
  show_at_ = now + kShowEvery;
  RelayStatus shown;
  shown.at = now;
  if (client()) shown.client = *client();
  for (const Direction direction : {Direction::Up, Direction::Down}) {
    const auto i = static_cast<std::size_t>(direction);
    const Channel& channel = this->channel(direction);
    const RelayTraffic& traffic = traffic_[i];
    shown.ways[i] = {.counters = channel.counters(),
                     .forwarded = traffic.forwarded,
                     .late_releases = traffic.late_releases,
                     .socket_errors = socket_errors(direction),
                     .changes = channel.impaired_path().changes_applied(),
                     .in_flight = channel.in_flight(),
                     .delay_p50 = traffic.delay.quantile(0.5),
                     .delay_p99 = traffic.delay.quantile(0.99),
                     .error_p99 = traffic.release_error.quantile(0.99)};
  }
  status.put(shown);
}

}  // namespace palp::netem
