#include "common/io/secure/path_check.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <utility>

#include <poll.h>
#include <sys/socket.h>

#include "common/core/number_text.h"
#include "common/io/process/descriptor.h"
#include "common/io/process/system_text.h"
#include "common/io/realtime/steady_clock.h"
#include "common/io/secure/dtls_handshake.h"
#include "common/io/secure/relay_message.h"
#include "common/link/link.h"

namespace palp::io {
namespace {

constexpr Duration kRoundTripMax = link::LinkConfig{}.round_trip_max;
/// More lost questions than this are no accident.
constexpr double kLostMax = 0.2;  // [-]

// Of a record of DTLS (RFC 6347, 4.1): its type, the last of six bytes of its number, and what is
// behind its header.
constexpr std::byte kHandshake{22};
constexpr std::size_t kNumberAt = 10;
constexpr std::size_t kBodyAt = 13;
constexpr std::byte kHelloVerifyRequest{3};

/// Which question it answers: a cookie has the number of the record it was asked with (4.2.1).
std::optional<std::size_t> question_of(std::span<const std::byte> datagram) {
  const bool cookie = datagram.size() > kBodyAt && datagram[0] == kHandshake &&
                      datagram[kBodyAt] == kHelloVerifyRequest;
  if (!cookie) return std::nullopt;
  return std::to_integer<std::size_t>(datagram[kNumberAt]);
}

std::optional<std::size_t> relay_question_of(std::span<const std::byte> datagram) {
  const auto message = RelayMessage::parse(datagram);
  if (!message || message->kind != RelayMessage::Kind::Cookie) return std::nullopt;
  return std::to_integer<std::size_t>(message->proof[0]);
}

/// Waits for one datagram, at the longest until then. Empty: none came.
DtlsDatagram hear_one(int socket, const SteadyClock& clock, TimePoint until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - clock.now()).count();
  pollfd watched{.fd = socket, .events = POLLIN, .revents = 0};
  if (::poll(&watched, 1, static_cast<int>(std::max<std::int64_t>(0, left))) <= 0) return {};
  DtlsDatagram bytes(2048);
  const ssize_t got = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  return bytes;
}

Result<Descriptor> connected_to(const HostAndPort& peer) {
  const Result<Endpoint> place = resolve(peer);
  if (!place) return fail(place.error().text);
  Descriptor socket{::socket(place->family(), SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!socket.valid() || ::connect(socket.number(), place->address(), place->size()) != 0) {
    return fail("cannot call " + peer.to_string() + ": " + system_text(errno));
  }
  return socket;
}

/// What is asked, and how answers are told apart.
struct Asked {
  std::vector<DtlsDatagram> datagrams;
  std::size_t number_at{};  ///< [bytes] into each of them
  std::optional<std::size_t> (*question_of)(std::span<const std::byte> datagram){};
};

/// Questions under way to one place.
class Questions {
 public:
  Questions(int socket, Asked asked)
      : socket_{socket}, hello_{std::move(asked.datagrams)}, asked_{std::move(asked)} {}

  void ask(TimePoint now) {
    for (DtlsDatagram& one : hello_) {
      one[asked_.number_at] = static_cast<std::byte>(asked_at_.size());
      (void)::send(socket_, one.data(), one.size(), MSG_DONTWAIT);
    }
    asked_at_.emplace_back(now);
  }
  /// Waits for one datagram, at the longest until then.
  void listen(const SteadyClock& clock, TimePoint until) {
    const DtlsDatagram heard = hear_one(socket_, clock, until);
    const auto number = asked_.question_of(heard);
    if (!number || *number >= asked_at_.size() || !asked_at_[*number]) return;
    round_trips_.push_back(clock.now() - *asked_at_[*number]);
    asked_at_[*number].reset();
  }
  [[nodiscard]] std::size_t asked() const { return asked_at_.size(); }
  [[nodiscard]] const std::vector<Duration>& round_trips() const { return round_trips_; }

 private:
  int socket_;
  std::vector<DtlsDatagram> hello_;
  Asked asked_;
  std::vector<std::optional<TimePoint>> asked_at_;  ///< by number; nullopt: answered
  std::vector<Duration> round_trips_;
};

Result<PathFacts> ask_all(const HostAndPort& peer, Asked asked, const PathCheckConfig& config) {
  const Result<Descriptor> socket = connected_to(peer);
  if (!socket) return tl::unexpected{socket.error()};
  Questions questions{socket->number(), std::move(asked)};
  const SteadyClock clock;
  TimePoint until{};
  while (questions.asked() < config.questions) {
    const TimePoint now = clock.now();
    questions.ask(now);
    until = now + config.patience;
    for (const TimePoint next = now + config.pause; clock.now() < next;) {
      questions.listen(clock, next);
    }
  }
  while (questions.round_trips().size() < questions.asked() && clock.now() < until) {
    questions.listen(clock, until);
  }
  return PathFacts{.asked = questions.asked(), .round_trips = questions.round_trips()};
}

}  // namespace

Result<PathFacts> read_path(const HostAndPort& peer,
                            const Credentials& credentials,
                            const PathCheckConfig& config) {
  return ask_all(
      peer, {DtlsHandshake{credentials}.take_datagrams(), kNumberAt, question_of}, config);
}

Result<MachineFinding> try_handshake(const HostAndPort& peer,
                                     const Credentials& credentials,
                                     Duration patience) {
  const Result<Descriptor> socket = connected_to(peer);
  if (!socket) return tl::unexpected{socket.error()};
  const SteadyClock clock;
  const TimePoint until = clock.now() + patience;
  DtlsHandshake handshake{credentials};
  const auto say = [&] {
    for (const DtlsDatagram& one : handshake.take_datagrams()) {
      (void)::send(socket->number(), one.data(), one.size(), MSG_DONTWAIT);
    }
  };
  for (say(); handshake.state() == DtlsHandshake::State::Running && clock.now() < until; say()) {
    const DtlsDatagram heard =
        hear_one(socket->number(), clock, clock.now() + std::chrono::milliseconds{5});
    if (!heard.empty()) handshake.hear(heard);
    handshake.tick();
  }
  const std::string what = credentials.fingerprint().empty() ? "shared key" : "certificates";
  if (const auto proof = handshake.take_result()) {
    return MachineFinding{what, "both sites take each other's: " + proof->peer_name, true, ""};
  }
  const DtlsFailure failure = handshake.state() == DtlsHandshake::State::Failed
                                  ? handshake.failure()
                                  : failure_of_silence(!credentials.fingerprint().empty());
  return MachineFinding{what, "no session would come about", false, failure.sentence};
}

Result<PathFacts> read_relay_path(const HostAndPort& relay, const PathCheckConfig& config) {
  const RelayMessage::Bytes ask = RelayMessage{}.bytes();
  constexpr std::size_t kProofAt = RelayMessage::kSize - sizeof(RoomProof);
  return ask_all(
      relay, {{DtlsDatagram{ask.begin(), ask.end()}}, kProofAt, relay_question_of}, config);
}

MachineFinding judge_path(const PathFacts& facts, PathGoal goal) {
  const bool relay = goal == PathGoal::Relay;
  const std::string what = relay ? "way to the relay" : "way to the peer";
  if (facts.round_trips.empty()) {
    return {what,
            "none of " + std::to_string(facts.asked) + " questions was answered",
            false,
            (relay ? "start palp-relay" : "start the patient site") +
                std::string{", and let UDP through to its port"}};
  }
  std::vector<Duration> sorted = facts.round_trips;
  std::sort(sorted.begin(), sorted.end());
  const auto lost = static_cast<double>(facts.asked) - static_cast<double>(sorted.size());
  const bool good =
      sorted.front() <= kRoundTripMax && lost <= kLostMax * static_cast<double>(facts.asked);
  return {what,
          number_text("round trip ", seconds(sorted.front()) * 1e3, 1, " ms at best") +
              number_text(", ", seconds(sorted[sorted.size() / 2]) * 1e3, 1, " in the middle") +
              number_text(", ", lost, 0, " of ") + std::to_string(facts.asked) + " lost",
          good,
          good ? ""
               : number_text("above ", seconds(kRoundTripMax), 1, " s, or with so much loss, ") +
                     "no session comes about: another network"};
}

}  // namespace palp::io
