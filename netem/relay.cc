#include "netem/relay.h"

#include <algorithm>

#include <poll.h>
#include <sched.h>
#include <time.h>

namespace palp::netem {
namespace {

using std::chrono::microseconds;

/// The kernel wakes a sleeper some 10-50 us late; this much of a wait is spun instead.
constexpr Duration kSpin = microseconds{60};
constexpr Duration kLate = microseconds{60};
/// A send call on a busy machine costs about 8 us; more is a disturbance, not a cost to lead by.
constexpr Duration kLeadMax = microseconds{20};
constexpr Duration kLeadStep{50};
/// A SCHED_FIFO thread that is awake for 95 % of a second is stopped for the rest of it by the
/// kernel: under a flood it naps before.
constexpr Duration kAwakeMax = microseconds{2000};
constexpr Duration kNap = microseconds{120};
/// Batches of one drain: bounds the time the other socket and the releases wait.
constexpr int kBatchesPerDrain = 4;

bool become_real_time(int priority) noexcept {
  if (priority <= 0) return false;
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

timespec to_timespec(Duration span) noexcept {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(span);
  return {.tv_sec = whole.count(), .tv_nsec = (span - whole).count()};
}

}  // namespace

Relay::Relay(const RelayConfig& config)
    : client_side_{DatagramSocket::bound(config.listen)},
      server_side_{DatagramSocket::connected(config.forward)},
      up_{config.up, config.seed, Direction::Up, config.in_flight_max, monotonic_now()},
      down_{config.down, config.seed, Direction::Down, config.in_flight_max, monotonic_now()},
      stop_descriptor_{config.stop_descriptor},
      real_time_{become_real_time(config.priority)},
      awake_since_{monotonic_now()} {}

bool Relay::serve(Duration span) {
  const TimePoint until = monotonic_now() + span;
  for (;;) {
    drain();
    const TimePoint now = monotonic_now();
    release(now);
    if (told_to_stop()) return false;
    if (now >= until) return true;
    rest(now, until);
  }
}

RelayTraffic Relay::traffic(Direction direction) const {
  RelayTraffic traffic = traffic_[static_cast<std::size_t>(direction)];
  traffic.socket_errors =
      direction == Direction::Up ? server_side_.errors() : client_side_.errors();
  return traffic;
}

void Relay::drain() noexcept {
  for (int batch = 0; batch < kBatchesPerDrain; ++batch) {
    const auto datagrams = client_side_.receive();
    if (datagrams.empty()) break;
    for (const ReceivedDatagram& datagram : datagrams) {
      up_.push(datagram.bytes, datagram.arrived_at);
    }
    client_ = datagrams.back().from;
  }
  for (int batch = 0; batch < kBatchesPerDrain; ++batch) {
    const auto datagrams = server_side_.receive();
    if (datagrams.empty()) break;
    for (const ReceivedDatagram& datagram : datagrams) {
      down_.push(datagram.bytes, datagram.arrived_at);
    }
  }
}

void Relay::release(TimePoint now) noexcept {
  release(Direction::Up, up_, now);
  release(Direction::Down, down_, now);
}

void Relay::release(Direction direction, Channel& channel, TimePoint now) noexcept {
  RelayTraffic& traffic = traffic_[static_cast<std::size_t>(direction)];
  TimePoint before = now;
  while (const auto released = channel.pop(buffer_, before + lead_)) {
    const auto bytes = std::span<const std::byte>{buffer_}.first(released->size);
    const bool sent = direction == Direction::Up ? server_side_.send(bytes, std::nullopt)
                                                 : client_ && client_side_.send(bytes, client_);
    const TimePoint after = monotonic_now();
    if (sent) {
      ++traffic.forwarded;
      traffic.delay.record(after - released->arrived_at);
      const Duration late = after - released->released_at;
      traffic.release_error.record(late < Duration{} ? -late : late);
      if (late > kLate) ++traffic.late_releases;
      // A step up or down at each call ends where half of the calls take longer.
      lead_ += after - before > lead_ ? kLeadStep : -kLeadStep;
      lead_ = std::clamp(lead_, Duration{}, kLeadMax);
    } else {
      ++traffic.unsent;
    }
    before = after;
  }
}

/// Waits in the kernel until shortly before the next release, or returns at once to spin.
void Relay::rest(TimePoint now, TimePoint until) noexcept {
  TimePoint next = until;
  if (const auto release = up_.next_release()) next = std::min(next, *release - lead_);
  if (const auto release = down_.next_release()) next = std::min(next, *release - lead_);
  if (real_time_ && now - awake_since_ > kAwakeMax) {
    const timespec nap = to_timespec(kNap);
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &nap, nullptr);
    awake_since_ = monotonic_now();
    return;
  }
  if (next - now <= kSpin) return;
  std::array<pollfd, 3> watched{{{client_side_.descriptor(), POLLIN, 0},
                                 {server_side_.descriptor(), POLLIN, 0},
                                 {stop_descriptor_, POLLIN, 0}}};
  const timespec wait = to_timespec(next - now - kSpin);
  ::ppoll(watched.data(), watched.size(), &wait, nullptr);
  const TimePoint woken = monotonic_now();
  if (woken - now > kNap / 4) awake_since_ = woken;
}

bool Relay::told_to_stop() const noexcept {
  if (stop_descriptor_ < 0) return false;
  pollfd watched{stop_descriptor_, POLLIN, 0};
  return ::poll(&watched, 1, 0) > 0;
}

}  // namespace palp::netem
