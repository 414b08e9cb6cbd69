#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/secure/relay_message.h"
#include "common/io/secure/room_key.h"

namespace palp::io {

/// A site's half of the talk with a relay: takes its seat in the room and keeps it. To the session
/// the relay is an address like any other. Knows no socket. Thread: io.
class RelayMember {
 public:
  /// A router forgets a UDP flow after 30 s at the earliest that we know.
  static constexpr Duration kKeepEvery = std::chrono::seconds{15};
  /// Without a session: so the relay knows who is still there.
  static constexpr Duration kAskEvery = std::chrono::seconds{1};
  /// While a session that works has fallen silent: the relay may have been started anew.
  static constexpr Duration kAskEveryInNeed = std::chrono::milliseconds{200};

  /// None without a relay. Asks the resolver. @throws std::runtime_error with one sentence.
  [[nodiscard]] static std::optional<RelayMember> at(const std::optional<HostAndPort>& relay,
                                                     const std::string& room,
                                                     link::Role role);
  RelayMember(RoomKey key, link::Role role, const Endpoint& relay, std::uint64_t entropy);

  [[nodiscard]] const Endpoint& relay() const noexcept { return relay_; }
  /// What has become of the session between the two sites.
  enum class SessionIs : std::uint8_t { None, Live, Silent };
  /// As far as the relay has said.
  [[nodiscard]] bool both_are_in() const noexcept { return seat_ == Seat::Both; }
  /// Often. nullopt: nothing to send.
  [[nodiscard]] std::optional<RelayMessage::Bytes> tick(TimePoint now, SessionIs session);
  /// A datagram that begins as a message of a relay does. @returns what to send back.
  [[nodiscard]] std::optional<RelayMessage::Bytes> hear(std::span<const std::byte> datagram,
                                                        const Endpoint& from,
                                                        TimePoint now);

  /// What people should know, once for each change.
  struct News {
    std::string sentence;
    bool good{};  ///< both sites are in the room
  };
  [[nodiscard]] std::optional<News> take_news();

 private:
  enum class Seat : std::uint8_t { None, Silent, Full, Alone, Both };

  [[nodiscard]] RelayMessage message(RelayMessage::Kind kind) const noexcept;

  RoomKey key_;
  link::Role role_;
  Endpoint relay_;
  std::uint64_t entropy_;
  std::uint64_t questions_{};
  std::optional<RoomProof> nonce_;  ///< of the question that waits for its cookie
  RelayMessage::Cookie cookie_{};   ///< of the Join under way, or the last one
  std::optional<TimePoint> began_at_;
  std::optional<TimePoint> asked_at_;
  std::optional<TimePoint> joined_at_;
  Seat seat_{Seat::None};
  Seat told_{Seat::None};
};

}  // namespace palp::io
