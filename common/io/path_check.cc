#include "common/io/path_check.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <poll.h>
#include <sys/socket.h>

#include "common/core/number_text.h"
#include "common/io/descriptor.h"
#include "common/io/dtls_handshake.h"
#include "common/io/steady_clock.h"
#include "common/io/system_text.h"

namespace palp::io {
namespace {

/// Above it no link becomes Live.
constexpr Duration kRoundTripMax = std::chrono::milliseconds{2500};
/// More lost questions than this are no accident.
constexpr double kLostMax = 0.2;  // [-]

/// HelloVerifyRequest (RFC 6347, 4.3.2): a record of a handshake, and behind its header the type 3.
bool is_cookie(std::span<const std::byte> datagram) {
  constexpr std::size_t kTypeAt = 13;
  return datagram.size() > kTypeAt && datagram[0] == std::byte{22} &&
         datagram[kTypeAt] == std::byte{3};
}

/// @returns whether a cookie came before `until`.
bool wait_for_cookie(const Descriptor& socket, const SteadyClock& clock, TimePoint until) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(until - clock.now()).count();
    if (left <= 0) return false;
    pollfd watched{.fd = socket.number(), .events = POLLIN, .revents = 0};
    if (::poll(&watched, 1, static_cast<int>(left)) <= 0) continue;
    std::array<std::byte, 2048> bytes{};
    const ssize_t got = ::recv(socket.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got > 0 && is_cookie(std::span{bytes}.first(static_cast<std::size_t>(got)))) return true;
  }
}

}  // namespace

Result<PathFacts> read_path(const HostAndPort& peer,
                            const Credentials& credentials,
                            const PathCheckConfig& config) {
  const Result<Endpoint> place = resolve(peer);
  if (!place) return fail(place.error().text);
  const Descriptor socket{::socket(place->family(), SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!socket.valid() || ::connect(socket.number(), place->address(), place->size()) != 0) {
    return fail("cannot call " + peer.to_string() + ": " + system_text(errno));
  }
  const std::vector<DtlsDatagram> hello = DtlsHandshake{credentials}.take_datagrams();
  const SteadyClock clock;
  PathFacts facts;
  for (; facts.asked < config.questions; ++facts.asked) {
    const TimePoint asked_at = clock.now();
    for (const DtlsDatagram& one : hello) {
      (void)::send(socket.number(), one.data(), one.size(), MSG_DONTWAIT);
    }
    if (!wait_for_cookie(socket, clock, asked_at + config.patience)) continue;
    facts.round_trips.push_back(clock.now() - asked_at);
    clock.sleep_until(clock.now() + config.pause);
  }
  return facts;
}

MachineFinding judge_path(const PathFacts& facts) {
  if (facts.round_trips.empty()) {
    return {"way to the peer",
            "none of " + std::to_string(facts.asked) + " questions was answered",
            false,
            "start the patient site, and let UDP through to its port"};
  }
  std::vector<Duration> sorted = facts.round_trips;
  std::sort(sorted.begin(), sorted.end());
  const auto lost = static_cast<double>(facts.asked) - static_cast<double>(sorted.size());
  const bool good =
      sorted.front() <= kRoundTripMax && lost <= kLostMax * static_cast<double>(facts.asked);
  return {"way to the peer",
          number_text("round trip ", seconds(sorted.front()) * 1e3, 1, " ms at best") +
              number_text(", ", seconds(sorted[sorted.size() / 2]) * 1e3, 1, " in the middle") +
              number_text(", ", lost, 0, " of ") + std::to_string(facts.asked) + " lost",
          good,
          good ? "" : "above 2.5 s, or with so much loss, no session comes about: another network"};
}

}  // namespace palp::io
