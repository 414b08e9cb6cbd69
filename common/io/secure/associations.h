#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/secure/admission.h"
#include "common/io/secure/credentials.h"
#include "common/io/secure/dtls_handshake.h"
#include "common/link/aead_protection.h"
#include "common/link/replay_window.h"

namespace palp::io {

/// Bytes for somebody.
struct Letter {
  Endpoint to;
  std::vector<std::byte> bytes;
};

/// What one handshake left: a proven peer and keys. `data` serves one session at most.
struct Association {
  std::uint64_t id{};  ///< ours, for this process; never 0
  Endpoint peer;       ///< where the handshake was made with, or where its holder has moved to
  DtlsResult proof;
  std::unique_ptr<link::AeadProtection> control;
  link::ReplayWindow received;  ///< control datagrams
  std::uint64_t next_number{};  ///< of control datagrams
  TimePoint heard_at{};         ///< or made
  bool heard{};                 ///< something sealed with its keys has come
  bool used{};                  ///< its data keys are a session's
};

/// The handshakes under way and what came of them; the control plane is sealed and opened here.
/// A surgeon calls, a patient answers. Whoever shows no valid cookie leaves nothing behind; those
/// who do may begin a few in a second, and only few are kept, those of hosts that never finish the
/// shortest. Thread: io.
class Associations {
 public:
  static constexpr std::size_t kAttemptsMax = 64;
  static constexpr std::size_t kKeptMax = 8;

  /// `credentials` outlives it.
  explicit Associations(const Credentials& credentials);

  /// Surgeon: a handshake with `peer`, unless one is running or the last began less than a second
  /// ago.
  void call(const Endpoint& peer, TimePoint now);
  /// A datagram that looks like DTLS.
  void hear(std::span<const std::byte> datagram, const Endpoint& from, TimePoint now);
  /// Every few milliseconds.
  void tick(TimePoint now);

  struct Opened {
    Association* association{};
    std::vector<std::byte> datagram;  ///< as PlainProtection would have it
  };
  /// A datagram of ours that is not data. nullopt: not sealed for us, seen before, or from another
  /// address than its sender's.
  [[nodiscard]] std::optional<Opened> open(std::span<const std::byte> datagram,
                                           const Endpoint& from,
                                           TimePoint now);
  /// Seals what PlainProtection framed.
  void send(Association& by, std::span<const std::byte> plain, const Endpoint& to);

  [[nodiscard]] Association* newest() noexcept;
  [[nodiscard]] Association* find(std::uint64_t id) noexcept;
  /// Forgets all but these two (0: none).
  void keep_only(std::uint64_t one, std::uint64_t other);

  [[nodiscard]] std::vector<Letter> take_letters();
  /// Ids of those made since the last call.
  [[nodiscard]] std::vector<std::uint64_t> take_made();
  /// One sentence about a handshake with somebody whose address is proven.
  [[nodiscard]] std::optional<DtlsFailure> take_failure();

 private:
  /// Whose header says so under its own mask. nullptr: none's.
  [[nodiscard]] Association* sender_of(std::span<const std::byte> datagram, link::Header& header);

  struct Attempt {
    Endpoint peer;
    std::optional<ClientRandom> random;  ///< patient: tells repetitions from another attempt
    DtlsHandshake handshake;
    TimePoint began_at{};
    bool told{};
  };
  void collect(Attempt& attempt, TimePoint now);
  void begin(Attempt attempt, TimePoint now);
  void make_room();

  const Credentials& credentials_;
  std::optional<DtlsListener> listener_;  ///< patient
  Admission admission_;                   ///< patient
  std::deque<Attempt> attempts_;          ///< oldest first
  std::deque<Association> kept_;          ///< oldest first
  std::uint64_t made_{};
  std::optional<TimePoint> called_at_;
  std::vector<Letter> letters_;
  std::vector<std::uint64_t> newly_made_;
  std::optional<DtlsFailure> failure_;
};

}  // namespace palp::io
