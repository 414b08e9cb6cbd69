#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/net/link_update_desk.h"
#include "common/io/secure/associations.h"
#include "common/link/packet_protection.h"
#include "common/link/session.h"
#include "common/link/traffic_keys.h"

namespace palp::io {

/// What a SessionEndpoint wants done after an input, in the order of the members.
struct SessionEndpointOutput {
  std::optional<link::SessionEvent> event;
  bool unanswered{};  ///< it refuses because nothing came back
  /// With Established: for the new session. Alone: replaces that of the present one.
  std::unique_ptr<link::PacketProtection> protection;
  /// With Established, where it is protected: for its video.
  std::optional<link::PlaneKeys> media;
  std::optional<Endpoint> moved_to;  ///< the peer of the present session now has this address
  Endpoint moved_from;  ///< had that one before, and is heard and told there too; none: it is not
  bool detours{};  ///< what was heard is a telegram for rt, from another address than the peer's
  std::vector<Letter> letters;
};

/// A Session and the protection of what it says. Knows no socket. Thread: io.
class SessionEndpoint {
 public:
  virtual ~SessionEndpoint() = default;
  /// Any bytes.
  [[nodiscard]] virtual SessionEndpointOutput hear(std::span<const std::byte> datagram,
                                                   const Endpoint& from,
                                                   TimePoint now) = 0;
  /// Every few milliseconds.
  [[nodiscard]] virtual SessionEndpointOutput tick(TimePoint now, const LinkGlance& link) = 0;
  /// We leave; nothing is said afterwards.
  [[nodiscard]] virtual SessionEndpointOutput close(std::string_view why) = 0;
  /// Where the connected socket sends from, as the kernel has it.
  virtual void set_own_address(const Endpoint& own) = 0;
  [[nodiscard]] virtual link::SessionCounters counters() const = 0;
  /// For people: who the peer has proven to be; empty: nobody has proven anything.
  [[nodiscard]] virtual std::string proof() const = 0;
  /// Of the certificate that the peer has proven itself with; empty: with none.
  [[nodiscard]] virtual std::string fingerprint() const = 0;
};

/// Neither encrypted nor authenticated: for benches within one machine.
class PlainSession final : public SessionEndpoint {
 public:
  /// `callee`: the surgeon's; none for a patient.
  PlainSession(const link::SessionConfig& config, std::uint64_t entropy, const Endpoint& callee)
      : session_{config, entropy}, peer_{callee}, callee_{callee} {}
  [[nodiscard]] SessionEndpointOutput hear(std::span<const std::byte> datagram,
                                           const Endpoint& from,
                                           TimePoint now) override;
  [[nodiscard]] SessionEndpointOutput tick(TimePoint now, const LinkGlance& link) override;
  [[nodiscard]] SessionEndpointOutput close(std::string_view why) override;
  void set_own_address(const Endpoint& /*own*/) override {}
  [[nodiscard]] link::SessionCounters counters() const override { return session_.counters(); }
  [[nodiscard]] std::string proof() const override { return {}; }
  [[nodiscard]] std::string fingerprint() const override { return {}; }

 private:
  [[nodiscard]] SessionEndpointOutput carried(link::SessionOutput output, const Endpoint& to);

  link::Session session_;
  Endpoint peer_;  ///< of the session
  Endpoint callee_;
};

}  // namespace palp::io
