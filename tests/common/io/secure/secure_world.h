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
  std::deque<std::vector<std::byte>> in;
  std::deque<std::vector<std::byte>> out;
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
    const auto bytes = std::move(wire_.in.front());
    wire_.in.pop_front();
    std::copy_n(bytes.begin(), std::min(bytes.size(), buffer.size()), buffer.begin());
    return link::Datagram{bytes.size(), now};
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

  void take(SessionEndpointOutput output, TimePoint now) {
    for (Letter& letter : output.letters) letters.push_back(std::move(letter));
    if (output.moved_to) {
      moved_to.push_back(*output.moved_to);
      detour = {};
      hears = *output.moved_to;
    }
    if (output.event) {
      if (const auto* session = std::get_if<link::Established>(&*output.event)) {
        established.push_back(*session);
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
  void tick(TimePoint now) {
    const link::Arrivals arrivals = link.receive(now);
    if (look) look(arrivals);
    link.send(telegram, now);
    const LinkHealth health = link.health(now);
    take(session_endpoint.tick(now,
                               {.state = health.state,
                                .session_id = health.session_id,
                                .newest_number = health.newest_number,
                                .key = health.key}),
         now);
  }

  Endpoint at;
  Endpoint hears;  ///< whom the data socket is connected to
  Detour detour;   ///< of that socket
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
      pass(*surgeon, *patient, surgeon_seen_at);
      pass(*patient, *surgeon, kPatientAt);
    }
  }
  /// What `from` has said goes on its way; what is due arrives at `to`.
  void pass(Site& from, Site& to, const Endpoint& seen_at) {
    auto& road = under_way_[from.at == kSurgeonAt ? 0 : 1];
    for (auto& bytes : std::exchange(from.wire.out, {})) {
      if (on_the_way) on_the_way(bytes);
      if (cut || (lose && lose())) continue;
      if (from.at == kSurgeonAt) recorded.push_back(bytes);
      if (from.detour.spend(bytes.size())) {
        if (from.detour.to() == elsewhere_watched) watched.push_back(bytes);
        road.push_back({now + way, false, from.detour.to(), seen_at, bytes});
      }
      road.push_back({now + way, false, from.hears, seen_at, std::move(bytes)});
    }
    for (Letter& letter : std::exchange(from.letters, {})) {
      if (on_the_way) on_the_way(letter.bytes);
      // Lost handshakes are repeated by OpenSSL's clock, which does not know this time.
      if (cut || (lose && !looks_like_dtls(letter.bytes) && lose())) continue;
      if (letter.to == elsewhere_watched) watched.push_back(letter.bytes);
      road.push_back({now + way, true, letter.to, seen_at, std::move(letter.bytes)});
    }
    for (; !road.empty() && road.front().due <= now; road.pop_front()) arrive(road.front(), to);
  }
  void arrive(Parcel& parcel, Site& to) {
    // An address that the surgeon had before leads nowhere.
    if (!(parcel.to == (to.at == kSurgeonAt ? surgeon_seen_at : to.at))) return;
    // As the kernel does: rt's socket is connected to the peer's address, the others go to io.
    if (!parcel.letter && parcel.from == to.hears) {
      to.wire.in.push_back(std::move(parcel.bytes));
      return;
    }
    if (parcel.letter) control.push_back(parcel.bytes);
    SessionEndpointOutput heard = to.session_endpoint.hear(parcel.bytes, parcel.from, now);
    if (heard.detours) {
      to.detour.heard(parcel.from, parcel.bytes.size());
      to.wire.in.push_back(parcel.bytes);
    }
    to.take(std::move(heard), now);
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
  Endpoint surgeon_seen_at{kSurgeonAt};
  Endpoint elsewhere_watched;
  std::vector<std::vector<std::byte>> watched;   ///< datagrams to that address
  std::vector<std::vector<std::byte>> recorded;  ///< telegrams of the surgeon
  std::vector<std::vector<std::byte>> control;   ///< handshakes and control messages of both

 private:
  std::array<std::deque<Parcel>, 2> under_way_;  ///< up, down
  Duration rekey_after_;
  std::uint64_t started_{};
};

}  // namespace palp::io::test
