#include "common/io/secure/relay_member.h"

#include <stdexcept>
#include <utility>

#include "common/core/random.h"
#include "common/io/process/entropy.h"

namespace palp::io {
namespace {

/// Without an answer, until people are told.
constexpr Duration kRelaySilence = std::chrono::seconds{3};

}  // namespace

std::optional<RelayMember> RelayMember::at(const std::optional<HostAndPort>& relay,
                                           const std::string& room,
                                           link::Role role) {
  if (!relay) return std::nullopt;
  const Result<Endpoint> place = resolve(*relay);
  if (!place) throw std::runtime_error{place.error().text};
  Result<RoomKey> key = RoomKey::from_name(room);
  if (!key) throw std::runtime_error{key.error().text};
  return RelayMember{std::move(*key), role, *place, draw_entropy()};
}

RelayMember::RelayMember(RoomKey key, link::Role role, const Endpoint& relay, std::uint64_t entropy)
    : key_{std::move(key)}, role_{role}, relay_{relay}, entropy_{entropy} {}

RelayMessage RelayMember::message(RelayMessage::Kind kind) const noexcept {
  RelayMessage made;
  made.kind = kind;
  made.role = role_;
  made.room = key_.id();
  return made;
}

std::optional<RelayMessage::Bytes> RelayMember::tick(TimePoint now, SessionIs session) {
  if (!began_at_) began_at_ = now;
  const bool seated = joined_at_ && now - *joined_at_ < kKeepEvery;
  const bool content = seated && seat_ == Seat::Both && session == SessionIs::Live;
  const Duration pause = session == SessionIs::Silent ? kAskEveryInNeed : kAskEvery;
  if (content || (asked_at_ && now - *asked_at_ < pause)) return std::nullopt;
  if (!joined_at_ && now - *began_at_ > kRelaySilence) seat_ = Seat::Silent;
  if (joined_at_ && now - *joined_at_ > kKeepEvery + kRelaySilence) seat_ = Seat::Silent;
  asked_at_ = now;
  ++questions_;
  nonce_.emplace();
  for (std::size_t i = 0; i < sizeof(std::uint64_t); ++i) {
    (*nonce_)[i] = static_cast<std::byte>(random_bits(entropy_, questions_, i) & 0xFFU);
  }
  RelayMessage ask = message(RelayMessage::Kind::Ask);
  ask.proof = *nonce_;
  return ask.bytes();
}

std::optional<RelayMessage::Bytes> RelayMember::hear(std::span<const std::byte> datagram,
                                                     const Endpoint& from,
                                                     TimePoint now) {
  using Kind = RelayMessage::Kind;
  const auto heard = RelayMessage::parse(datagram);
  if (!heard || !(from == relay_) || heard->role != role_ || heard->room != key_.id() ||
      !asked_at_) {
    return std::nullopt;
  }
  if (heard->kind == Kind::Cookie && heard->proof == nonce_) {
    nonce_.reset();  // one Join for a question
    RelayMessage join = message(Kind::Join);
    join.cookie = cookie_ = heard->cookie;
    join.proof = key_.sign(join.claim());
    return join.bytes();
  }
  // Whoever has not seen our Join does not know its cookie.
  if (heard->cookie != cookie_ || cookie_ == RelayMessage::Cookie{}) return std::nullopt;
  if (heard->kind == Kind::Joined) {
    joined_at_ = now;
    seat_ = heard->detail == 1 ? Seat::Both : Seat::Alone;
  } else if (heard->kind == Kind::Refused) {
    seat_ = Seat::Full;
  }
  return std::nullopt;
}

std::optional<RelayMember::News> RelayMember::take_news() {
  if (seat_ == std::exchange(told_, seat_)) return std::nullopt;
  const std::string relay = "the relay at " + relay_.to_string();
  switch (seat_) {
    case Seat::None:
      return std::nullopt;
    case Seat::Silent:
      return News{relay + " does not answer: is palp-relay running there, and UDP let through?",
                  false};
    case Seat::Full:
      return News{relay + " is full: another relay, or later", false};
    case Seat::Alone:
      return News{"nobody else is in the room at " + relay +
                      ": start the other site, with the same"
                      " --room",
                  false};
    case Seat::Both:
      return News{"both sites are in the room at " + relay, true};
  }
  return std::nullopt;
}

}  // namespace palp::io
