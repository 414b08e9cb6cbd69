#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/io/net/detour.h"
#include "common/io/net/side_inbox.h"
#include "common/io/secure/dtls_session.h"
#include "common/link/codec_wire.h"
#include "common/link/link.h"
#include "tests/common/io/secure/keys_folder.h"

/// Two sites under keys in one thread and virtual time, letters passed by hand; a real handshake
/// with real certificates begins each session.
namespace palp::io::test {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;

inline const Endpoint kPatientAt = *resolve_endpoint("127.0.0.1:2000");
inline const Endpoint kSurgeonAt = *resolve_endpoint("127.0.0.1:1000");
inline const Endpoint kElsewhere = *resolve_endpoint("127.0.0.1:1001");

inline link::SessionConfig session_of(Role role) {
  return {.role = role, .settings_hash = 77, .coupling = "direct", .git = "abc"};
}

/// Datagrams that wait for a Link, and those it has sent.
struct Wire {
  struct Waiting {
    std::vector<std::byte> bytes;
    bool straight{};  ///< came over the peer's address
  };
  std::deque<Waiting> in;
  std::deque<std::vector<std::byte>> out;
  Detour detour;
  bool straight{};  ///< what was taken last
};

class WireEnd final : public link::Transport {
 public:
  explicit WireEnd(Wire& wire) : wire_{wire} {}
  bool send(std::span<const std::byte> datagram, TimePoint) noexcept override {
    wire_.out.emplace_back(datagram.begin(), datagram.end());
    return true;
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    if (wire_.in.empty()) return std::nullopt;
    wire_.straight = wire_.in.front().straight;
    const auto bytes = std::move(wire_.in.front().bytes);
    wire_.in.pop_front();
    std::copy_n(bytes.begin(), std::min(bytes.size(), buffer.size()), buffer.begin());
    return link::Datagram{bytes.size(), now};
  }
  void recognised(TimePoint now) noexcept override {
    if (wire_.straight) wire_.detour.heard_straight(now);
  }

 private:
  Wire& wire_;
};

/// A site's io thread without sockets, and its Link.
struct Site {
  Site(Role role, const Credentials& credentials, Duration rekey_after, std::uint64_t entropy)
      : at{role == Role::Surgeon ? kSurgeonAt : kPatientAt},
        hears{role == Role::Surgeon ? kPatientAt : kSurgeonAt},
        session_endpoint{{.session = session_of(role),
                          .callee = role == Role::Surgeon ? kPatientAt : Endpoint{},
                          .rekey_after = rekey_after},
                         credentials,
                         entropy} {}

  /// `from`: where the datagram came from that is answered, if one came.
  void take(SessionEndpointOutput output, TimePoint now, const Endpoint& from = {}) {
    for (Letter& letter : output.letters) letters.push_back(std::move(letter));
    if (output.moved_to) {
      moved_to.push_back(*output.moved_to);
      wire.detour = Detour{output.moved_from};
      hears = *output.moved_to;
    }
    if (output.event) {
      if (const auto* session = std::get_if<link::Established>(&*output.event)) {
        established.push_back(*session);
        if (from.valid()) hears = from;
        if (wrap_protection) output.protection = wrap_protection(std::move(output.protection));
        (void)link.adopt({.transport = std::make_unique<WireEnd>(wire),
                          .protection = std::move(output.protection),
                          .send_connection = session->send_connection,
                          .receive_connection = session->receive_connection,
                          .session_id = session->session_id},
                         now);
      } else if (const auto* refusal = std::get_if<link::Refused>(&*output.event)) {
        refused.push_back(refusal->text);
      } else {
        ++closed;
        (void)link.adopt({}, now);
      }
    }
    if (output.protection) {
      ++rekeyed;
      const link::Established& session = established.back();
      (void)link.adopt({.transport = nullptr,
                        .protection = std::move(output.protection),
                        .send_connection = session.send_connection,
                        .receive_connection = session.receive_connection,
                        .session_id = session.session_id,
                        .continues = true},
                       now);
    }
  }
  /// As UdpSocket does.
  void take_detours(TimePoint now) {
    wire.detour.begin_tick(now);
    for (; !aside.empty(); aside.pop_front()) {
      const SideDatagram& one = aside.front();
      const Detour::Fate fate = wire.detour.fate(one.from, one.arrived_at, now);
      if (fate == Detour::Fate::Wait) return;
      if (fate == Detour::Fate::Drop) continue;
      if (!(one.from == hears)) wire.detour.heard(one.from, one.datagram().size());
      const auto bytes = one.datagram();
      wire.in.push_back({.bytes = {bytes.begin(), bytes.end()}, .straight = false});
    }
  }
  void tick(TimePoint now) {
    take_detours(now);
    const link::Arrivals arrivals = link.receive(now);
    if (look) look(arrivals);
    link.send(telegram, now);
    const LinkHealth health = link.health(now);
    take(session_endpoint.tick(now,
                               {.state = health.state,
                                .session_id = health.session_id,
                                .newest_number = health.newest_number,
                                .key = health.key,
                                .peer_heard_at = wire.detour.straight_at()}),
         now);
  }

  Endpoint at;
  Endpoint hears;  ///< whom the data socket is connected to
  std::deque<SideDatagram> aside;
  DtlsSession session_endpoint;
  link::Link link{{}, std::make_unique<link::WireCodec>()};
  Wire wire;
  std::deque<Letter> letters;
  std::vector<link::Established> established;
  std::vector<std::string> refused;
  std::vector<Endpoint> moved_to;
  Telegram telegram;
  std::function<void(const link::Arrivals&)> look;
  /// Puts something around the protection of each new session.
  std::function<std::unique_ptr<link::PacketProtection>(std::unique_ptr<link::PacketProtection>)>
      wrap_protection;
  int closed{};
  int rekeyed{};
};

/// A telegram or a letter on its way.
struct Parcel {
  TimePoint due{};
  bool letter{};
  Endpoint to;
  Endpoint from;  ///< as its receiver sees it
  std::vector<std::byte> bytes;
};

/// Both sites and what lies between.
class World {
 public:
  explicit World(const std::string& name, Duration rekey_after = std::chrono::hours{1})
      : keys{name},
        surgeon_credentials{keys.credentials(Role::Surgeon)},
        patient_credentials{keys.credentials(Role::Patient)},
        rekey_after_{rekey_after} {
    start(Role::Surgeon);
    start(Role::Patient);
  }
  void start(Role role) {
    auto& site = role == Role::Surgeon ? surgeon : patient;
    site =
        std::make_unique<Site>(role,
                               role == Role::Surgeon ? *surgeon_credentials : *patient_credentials,
                               rekey_after_,
                               ++started_);
  }
  void run(Duration span) {
    for (const TimePoint end = now + span; now < end; now += milliseconds{1}) {
      surgeon->tick(now);
      patient->tick(now);
      std::vector<Parcel> early = std::exchange(thrown_, {});
      for (Parcel& one : early) {
        if (one.due > now) {
          thrown_.push_back(std::move(one));
        } else {
          arrive(one, one.to == kPatientAt ? *patient : *surgeon);
        }
      }
      pass(*surgeon, *patient, surgeon_seen_at);
      pass(*patient, *surgeon, kPatientAt);
      if (each_ms) each_ms();
    }
  }
  /// Somebody on the way sends it, under whatever address.
  void throw_in(Parcel parcel) { thrown_.push_back(std::move(parcel)); }
  /// What `from` has said goes on its way; what is due arrives at `to`.
  void pass(Site& from, Site& to, const Endpoint& seen_at) {
    auto& road = under_way_[from.at == kSurgeonAt ? 0 : 1];
    const auto set_out = [&](bool letter, const Endpoint& where, std::vector<std::byte> bytes) {
      if (where == elsewhere_watched) watched.push_back(bytes);
      road.push_back({now + way, letter, where, seen_at, std::move(bytes)});
      if (observer) observer(road.back());
      if (lose_after_observer && lose_after_observer(road.back())) road.pop_back();
    };
    for (auto& bytes : std::exchange(from.wire.out, {})) {
      if (on_the_way) on_the_way(bytes);
      if (cut || (lose && lose())) continue;
      if (from.at == kSurgeonAt) recorded.push_back(bytes);
      for (std::size_t at = 0; at < Detour::kPlaces; ++at) {
        const Endpoint* copied_to = from.wire.detour.spend(at, bytes.size(), now);
        if (copied_to != nullptr) set_out(false, *copied_to, bytes);
      }
      set_out(false, from.hears, std::move(bytes));
    }
    for (Letter& letter : std::exchange(from.letters, {})) {
      if (on_the_way) on_the_way(letter.bytes);
      // Lost handshakes are repeated by OpenSSL's clock, which does not know this time.
      if (cut || (lose && !looks_like_dtls(letter.bytes) && lose())) continue;
      set_out(true, letter.to, std::move(letter.bytes));
    }
    for (; !road.empty() && road.front().due <= now; road.pop_front()) arrive(road.front(), to);
  }
  void arrive(Parcel& parcel, Site& to) {
    // An address that the surgeon had before leads nowhere.
    if (!(parcel.to == (to.at == kSurgeonAt ? surgeon_seen_at : to.at))) return;
    // As the kernel does: rt's socket is connected to the peer's address, the others go to io.
    if (!parcel.letter && parcel.from == to.hears) {
      to.wire.in.push_back({.bytes = std::move(parcel.bytes), .straight = true});
      return;
    }
    if (parcel.letter) control.push_back(parcel.bytes);
    SessionEndpointOutput heard = to.session_endpoint.hear(parcel.bytes, parcel.from, now);
    if (heard.detours) to.aside.emplace_back(parcel.bytes, parcel.from, now);
    to.take(std::move(heard), now, parcel.from);
  }
  [[nodiscard]] LinkState state(const Site& site) const { return site.link.health(now).state; }
  [[nodiscard]] bool live() const {
    return state(*surgeon) == LinkState::Live && state(*patient) == LinkState::Live;
  }

  KeysFolder keys;
  std::unique_ptr<Credentials> surgeon_credentials;
  std::unique_ptr<Credentials> patient_credentials;
  std::unique_ptr<Site> surgeon;
  std::unique_ptr<Site> patient;
  TimePoint now{};
  Duration way{};  ///< each way
  bool cut{};
  std::function<bool()> lose;
  std::function<void(std::span<const std::byte>)> on_the_way;  ///< told of all that is sent
  std::function<void(const Parcel&)> observer;  ///< somebody on the way, who sees all that passes
  std::function<bool(const Parcel&)> lose_after_observer;  ///< between him and its receiver
  std::function<void()> each_ms;
  Endpoint surgeon_seen_at{kSurgeonAt};
  Endpoint elsewhere_watched;
  std::vector<std::vector<std::byte>> watched;   ///< datagrams to that address
  std::vector<std::vector<std::byte>> recorded;  ///< telegrams of the surgeon
  std::vector<std::vector<std::byte>> control;   ///< handshakes and control messages of both

 private:
  std::array<std::deque<Parcel>, 2> under_way_;  ///< up, down
  std::vector<Parcel> thrown_;
  Duration rekey_after_;
  std::uint64_t started_{};
};

/// Whether a sealed datagram is a question about a path, or the answer to one.
inline bool is_path(std::span<const std::byte> bytes) {
  const auto header = link::parse_clear_part(bytes);
  return header && header->type == link::PacketType::Path;
}

/// A session in which the surgeon is behind something that changes addresses, or not; lives after.
inline void begin(World& world, bool translated) {
  world.way = std::chrono::milliseconds{25};
  world.surgeon->session_endpoint.set_own_address(translated ? *resolve_endpoint("10.0.0.7:1000")
                                                             : kSurgeonAt);
  world.run(std::chrono::seconds{2});
}

}  // namespace palp::io::test
