#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/secure/credentials.h"
#include "common/io/secure/dtls_failure.h"
#include "common/link/traffic_keys.h"

namespace palp::io {

using DtlsDatagram = std::vector<std::byte>;

/// What a handshake leaves behind.
struct DtlsResult {
  link::SessionKeys keys;
  link::PlaneKeys media;         ///< of the session's video
  std::string peer_name;         ///< in the peer's certificate, for people
  std::string peer_fingerprint;  ///< SHA-256 of it; equal where it is the same peer
};

/// First byte of a DTLS record (RFC 5764, 5.1.2); ours begin at 0x80.
[[nodiscard]] bool looks_like_dtls(std::span<const std::byte> datagram) noexcept;

/// The random of the ClientHello in this datagram, which all repetitions of one attempt share;
/// nullopt: no ClientHello.
using ClientRandom = std::array<std::byte, 32>;
[[nodiscard]] std::optional<ClientRandom> client_random(
    std::span<const std::byte> datagram) noexcept;

/// Whether the ClientHello in this datagram shows a cookie, whatever that is worth.
[[nodiscard]] bool shows_cookie(std::span<const std::byte> datagram) noexcept;

/// One DTLS 1.2 handshake; nothing but keys is taken from it, no record ever carries our data.
/// Repeats what got lost 200 ms after, x 1.5 each time, up to 0.4 s. Datagrams in and out; knows no
/// socket. Uses OpenSSL's own clock for its timer. Thread: io.
class DtlsHandshake {
 public:
  enum class State : std::uint8_t { Running, Done, Failed };

  /// A surgeon's: begins with its first datagram. `credentials` outlives it.
  explicit DtlsHandshake(const Credentials& credentials);
  ~DtlsHandshake();
  DtlsHandshake(DtlsHandshake&&) noexcept;
  DtlsHandshake& operator=(DtlsHandshake&&) noexcept;

  void hear(std::span<const std::byte> datagram);
  /// Every few milliseconds while running.
  void tick();
  [[nodiscard]] State state() const noexcept { return state_; }
  /// Once Failed.
  [[nodiscard]] const DtlsFailure& failure() const noexcept { return failure_; }
  /// Once Done; only once.
  [[nodiscard]] std::optional<DtlsResult> take_result();
  /// What is to be sent to the peer, in order.
  [[nodiscard]] std::vector<DtlsDatagram> take_datagrams();

 private:
  friend class DtlsListener;
  struct Parts;
  explicit DtlsHandshake(std::unique_ptr<Parts> parts, link::Role role);
  void go_on();
  void finish();

  std::unique_ptr<Parts> parts_;
  link::Role role_;
  State state_{State::Running};
  DtlsFailure failure_;
  std::optional<DtlsResult> result_;
};

/// A patient's door: answers each ClientHello with a cookie, and keeps nothing of whoever does not
/// bring it back from the address it was sent to. Cookies are good for one to two minutes.
/// Thread: io.
class DtlsListener {
 public:
  /// `credentials` outlives it.
  explicit DtlsListener(const Credentials& credentials);
  ~DtlsListener();
  DtlsListener(const DtlsListener&) = delete;
  DtlsListener& operator=(const DtlsListener&) = delete;

  struct Answer {
    std::vector<DtlsDatagram> datagrams;
    std::optional<DtlsHandshake> handshake;  ///< its address has been proven
  };
  [[nodiscard]] Answer hear(std::span<const std::byte> datagram,
                            const Endpoint& from,
                            TimePoint now);

 private:
  struct Cookies;
  const Credentials& credentials_;
  std::unique_ptr<Cookies> cookies_;
  std::unique_ptr<DtlsHandshake::Parts> waiting_;
};

}  // namespace palp::io
