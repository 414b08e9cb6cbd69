#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/secure/address_cookie.h"
#include "common/io/secure/relay_message.h"

namespace palp::relay {

/// What a relay has done, for its report.
struct RoomCounts {
  std::uint64_t forwarded{};
  std::uint64_t alone{};    ///< from a member whose room the other site has not entered
  std::uint64_t unknown{};  ///< from nobody's seat
  std::uint64_t over_rate{};
  std::uint64_t junk{};  ///< looked like a message to the relay, and was none
  std::uint64_t cookies{};
  std::uint64_t joins{};    ///< seats taken, kept or moved
  std::uint64_t forged{};   ///< Joins without a cookie of ours, or without a proof
  std::uint64_t stale{};    ///< Joins older than what sits there: replayed
  std::uint64_t refused{};  ///< for want of room
};

/// Who sits where, and what becomes of a datagram. It reads nothing of what it forwards. Until an
/// address has shown a cookie nothing of it is remembered; proofs, seats and datagrams are
/// rationed, so that memory and work are bounded whatever comes. No answer is longer than what it
/// answers. Knows no socket and no clock. Thread: its owner's.
class Rooms {
 public:
  static constexpr std::size_t kRoomsMax = 64;
  static constexpr std::size_t kSeatsPerHostMax = 16;
  static constexpr double kRateMax = 3000;  ///< [datagrams/s] of a member
  static constexpr double kBurstMax = 600;  ///< [datagrams]
  /// Proofs looked at, of one host and of all; each costs 0.1 ms.
  static constexpr double kProofsPerHostMax = 20;  ///< [1/s]
  static constexpr double kProofsMax = 1000;       ///< [1/s]
  static constexpr Duration kIdleMax = std::chrono::seconds{60};
  /// Who has not been heard for so long keeps the seat, but nobody is told to be in the room with
  /// it: several times the pause between a waiting site's Joins.
  static constexpr Duration kPresentMax = std::chrono::seconds{4};

  /// Where a datagram goes; `bytes` are those that came, or an answer that the next call forgets.
  struct Outgoing {
    io::Endpoint to;
    std::span<const std::byte> bytes;
  };
  [[nodiscard]] std::optional<Outgoing> hear(std::span<const std::byte> datagram,
                                             const io::Endpoint& from,
                                             TimePoint now);

  [[nodiscard]] const RoomCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] std::size_t rooms() const noexcept { return rooms_.size(); }

 private:
  /// Lets through so many a second, and a burst.
  struct Ration {
    double left{};  ///< [1]
    TimePoint at{};
    [[nodiscard]] bool spend(double rate, double burst, TimePoint now) noexcept;
  };
  struct Seat {
    io::Endpoint address;
    TimePoint cookie_at{};  ///< when the cookie of its Join was made
    TimePoint heard_at{};
    Ration ration;
  };
  struct Room {
    std::array<Seat, 2> seats;  ///< surgeon, patient
  };
  struct Place {
    io::RoomId room{};
    std::size_t seat{};
  };
  struct HostRation {
    io::Endpoint host;
    Ration ration;
  };

  [[nodiscard]] std::optional<Outgoing> forward(std::span<const std::byte> datagram,
                                                const io::Endpoint& from,
                                                TimePoint now);
  [[nodiscard]] std::optional<Outgoing> join(const io::RelayMessage& message,
                                             const io::Endpoint& from,
                                             TimePoint now);
  [[nodiscard]] std::optional<Outgoing> answer(io::RelayMessage message,
                                               io::RelayMessage::Kind kind,
                                               const io::Endpoint& to);
  [[nodiscard]] bool may_prove(const io::Endpoint& from, TimePoint now);
  [[nodiscard]] bool has_room(const io::RoomId& room, const io::Endpoint& from) const;
  void forget_idle(TimePoint now);
  void leave(const io::Endpoint& address);

  io::AddressCookie cookies_;
  std::map<io::RoomId, Room> rooms_;
  std::map<io::Endpoint::Bytes, Place> places_;  ///< of the seats taken
  std::array<HostRation, 64> hosts_;  ///< by a hash of the host; who comes later, replaces
  Ration proofs_;
  TimePoint looked_at_{};
  io::RelayMessage::Bytes answer_{};
  RoomCounts counts_;
};

}  // namespace palp::relay
