#include "relay/rooms.h"

#include <algorithm>
#include <utility>

namespace palp::relay {
namespace {

using io::RelayMessage;

std::size_t seat_of(link::Role role) noexcept { return role == link::Role::Surgeon ? 0 : 1; }

/// What a cookie is for: a seat.
std::array<std::byte, sizeof(io::RoomId) + 1> purpose_of(const RelayMessage& message) noexcept {
  std::array<std::byte, sizeof(io::RoomId) + 1> bytes{};
  std::ranges::copy(message.room, bytes.begin());
  bytes.back() = static_cast<std::byte>(seat_of(message.role));
  return bytes;
}

/// The same for all addresses of a host (Endpoint::same_host).
std::size_t host_number(const io::Endpoint& host) noexcept {
  const io::Endpoint::Bytes bytes = host.bytes();
  const bool ipv4 = std::all_of(
      bytes.begin(), bytes.begin() + 10, [](std::byte one) { return one == std::byte{0}; });
  std::size_t number = 17;
  for (std::size_t i = 0; i < (ipv4 ? 16U : 8U); ++i) {
    number = number * 31 + std::to_integer<std::size_t>(bytes[i]);
  }
  return number;
}

}  // namespace

bool Rooms::Ration::spend(double rate, double burst, TimePoint now) noexcept {
  left = std::min(burst, left + rate * seconds(now - at));
  at = now;
  if (left < 1) return false;
  left -= 1;
  return true;
}

std::optional<Rooms::Outgoing> Rooms::hear(std::span<const std::byte> datagram,
                                           const io::Endpoint& from,
                                           TimePoint now) {
  if (now - looked_at_ >= std::chrono::seconds{1}) forget_idle(now);
  if (datagram.empty() || datagram[0] != RelayMessage::kFirstByte) {
    return forward(datagram, from, now);
  }
  const auto message = RelayMessage::parse(datagram);
  if (message && message->kind == RelayMessage::Kind::Ask) {
    RelayMessage cookie = *message;
    cookie.cookie = cookies_.make(from, purpose_of(cookie), now);
    ++counts_.cookies;
    return answer(cookie, RelayMessage::Kind::Cookie, from);
  }
  if (message && message->kind == RelayMessage::Kind::Join) return join(*message, from, now);
  ++counts_.junk;
  return std::nullopt;
}

std::optional<Rooms::Outgoing> Rooms::forward(std::span<const std::byte> datagram,
                                              const io::Endpoint& from,
                                              TimePoint now) {
  const auto place = places_.find(from.bytes());
  if (place == places_.end()) {
    ++counts_.unknown;
    return std::nullopt;
  }
  Room& room = rooms_.find(place->second.room)->second;
  Seat& own = room.seats[place->second.seat];
  const Seat& other = room.seats[1 - place->second.seat];
  if (!own.ration.spend(kRateMax, kBurstMax, now)) {
    ++counts_.over_rate;
    return std::nullopt;
  }
  own.heard_at = now;
  if (!other.address.valid()) {
    ++counts_.alone;
    return std::nullopt;
  }
  ++counts_.forwarded;
  return Outgoing{other.address, datagram};
}

std::optional<Rooms::Outgoing> Rooms::join(const io::RelayMessage& message,
                                           const io::Endpoint& from,
                                           TimePoint now) {
  const auto made_at = cookies_.made_at(message.cookie, from, purpose_of(message), now);
  if (!made_at) {
    ++counts_.forged;
    return std::nullopt;
  }
  const std::size_t number = seat_of(message.role);
  const auto known = rooms_.find(message.room);
  if (known != rooms_.end() && known->second.seats[number].address.valid() &&
      *made_at <= known->second.seats[number].cookie_at) {
    ++counts_.stale;  // a copy of what was said here before must not bring its sender back
    return std::nullopt;
  }
  if (!may_prove(from, now)) {
    ++counts_.over_rate;
    return std::nullopt;
  }
  if (!io::proves_room(message.room, message.claim(), message.proof)) {
    ++counts_.forged;
    return std::nullopt;
  }
  if (!has_room(message.room, from)) {
    ++counts_.refused;
    return answer(message, RelayMessage::Kind::Refused, from);
  }
  const auto here = places_.find(from.bytes());
  const bool elsewhere =
      here != places_.end() && (here->second.room != message.room || here->second.seat != number);
  if (elsewhere) leave(from);
  Room& room = rooms_[message.room];
  Seat& seat = room.seats[number];
  if (seat.address.valid()) places_.erase(seat.address.bytes());
  const Ration ration = seat.address == from ? seat.ration : Ration{kBurstMax, now};
  seat = {.address = from, .cookie_at = *made_at, .heard_at = now, .ration = ration};
  places_[from.bytes()] = {.room = message.room, .seat = number};
  ++counts_.joins;
  RelayMessage joined = message;
  const Seat& other = room.seats[1 - number];
  joined.detail = other.address.valid() && now - other.heard_at <= kPresentMax ? 1 : 0;
  return answer(joined, RelayMessage::Kind::Joined, from);
}

std::optional<Rooms::Outgoing> Rooms::answer(io::RelayMessage message,
                                             io::RelayMessage::Kind kind,
                                             const io::Endpoint& to) {
  message.kind = kind;
  if (kind != RelayMessage::Kind::Cookie) message.proof = {};
  answer_ = message.bytes();
  return Outgoing{to, answer_};
}

bool Rooms::may_prove(const io::Endpoint& from, TimePoint now) {
  HostRation& host = hosts_[host_number(from) % hosts_.size()];
  if (!host.host.same_host(from)) {
    host = {.host = from, .ration = {.left = kProofsPerHostMax, .at = now}};
  }
  return host.ration.spend(kProofsPerHostMax, kProofsPerHostMax, now) &&
         proofs_.spend(kProofsMax, kProofsMax, now);
}

bool Rooms::has_room(const io::RoomId& room, const io::Endpoint& from) const {
  const auto known = rooms_.find(room);
  if (known == rooms_.end() && rooms_.size() >= kRoomsMax) return false;
  std::size_t seats = 0;
  for (const auto& [id, one] : rooms_) {
    if (id == room) continue;
    seats += static_cast<std::size_t>(std::ranges::count_if(
        one.seats, [&](const Seat& seat) { return seat.address.same_host(from); }));
  }
  return seats < kSeatsPerHostMax;
}

void Rooms::leave(const io::Endpoint& address) {
  const auto place = places_.find(address.bytes());
  if (place == places_.end()) return;
  const auto room = rooms_.find(place->second.room);
  room->second.seats[place->second.seat] = {};
  const bool empty = std::ranges::none_of(room->second.seats,
                                          [](const Seat& seat) { return seat.address.valid(); });
  if (empty) rooms_.erase(room);
  places_.erase(place);
}

void Rooms::forget_idle(TimePoint now) {
  looked_at_ = now;
  std::array<io::Endpoint, 2 * kRoomsMax> idle;
  std::size_t count = 0;
  for (const auto& [id, room] : rooms_) {
    for (const Seat& seat : room.seats) {
      if (seat.address.valid() && now - seat.heard_at > kIdleMax) idle[count++] = seat.address;
    }
  }
  for (const io::Endpoint& address : std::span{idle}.first(count)) leave(address);
}

}  // namespace palp::relay
