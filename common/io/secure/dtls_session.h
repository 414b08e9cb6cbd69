#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/io/secure/associations.h"
#include "common/io/secure/roaming.h"
#include "common/io/secure/session_endpoint.h"

namespace palp::io {

struct DtlsSessionConfig {
  link::SessionConfig session;
  Endpoint callee;  ///< the surgeon's; none for a patient
  /// Age at which the surgeon replaces the keys of a session by those of a new handshake.
  Duration rekey_after{std::chrono::hours{1}};
};

/// A Session that speaks under the keys of DTLS handshakes only: whoever has not proven a role is
/// never heard. The surgeon makes a handshake for each session, for new keys within one, and where
/// the peer does not answer any more; the patient follows a surgeon whose address changes.
/// Thread: io.
class DtlsSession final : public SessionEndpoint {
 public:
  /// `credentials` outlives it.
  DtlsSession(const DtlsSessionConfig& config,
              const Credentials& credentials,
              std::uint64_t entropy);
  [[nodiscard]] SessionEndpointOutput hear(std::span<const std::byte> datagram,
                                           const Endpoint& from,
                                           TimePoint now) override;
  [[nodiscard]] SessionEndpointOutput tick(TimePoint now, const LinkGlance& link) override;
  [[nodiscard]] SessionEndpointOutput close(std::string_view why) override;
  void set_own_address(const Endpoint& own) override { path_answers_.set_own(own); }
  [[nodiscard]] link::SessionCounters counters() const override;
  [[nodiscard]] std::string proof() const override { return proof_; }
  [[nodiscard]] std::string fingerprint() const override { return fingerprint_; }

 private:
  void hear_sealed(std::span<const std::byte> datagram,
                   const Endpoint& from,
                   TimePoint now,
                   SessionEndpointOutput& out);
  /// @returns whether it is new and authentic.
  [[nodiscard]] bool hear_data(std::span<const std::byte> datagram,
                               const Endpoint& from,
                               TimePoint now);
  void hear_path(const Associations::Opened& opened, const Endpoint& from, TimePoint now);
  [[nodiscard]] Roaming::Straight straight(TimePoint now) const;
  void follow(TimePoint now, SessionEndpointOutput& out);
  void send_path(Association& by, const PathMessage& message, const Endpoint& to);
  void say(const link::SessionOutput& output, Association& by, const Endpoint& to);
  void establish(Association& by, const Endpoint& from, SessionEndpointOutput& out);
  void forget();
  void replace_keys(Association& by, TimePoint now, SessionEndpointOutput& out);
  void end_changeover(SessionEndpointOutput& out);
  void speak_as_surgeon(const link::SessionOutput& output,
                        const std::vector<std::uint64_t>& made,
                        TimePoint now);
  void greet(TimePoint now);
  void tell_failure(TimePoint now, SessionEndpointOutput& out);
  [[nodiscard]] link::TrafficKeys data_keys(const Association& of, std::uint8_t id) const;

  DtlsSessionConfig config_;
  link::Session session_;
  Associations associations_;
  LinkGlance link_;
  std::string proof_;
  std::string fingerprint_;
  std::uint64_t present_{};  ///< association whose data keys the session has; 0: no session
  std::uint64_t next_{};     ///< the one that replaces it, during a changeover
  std::uint8_t key_id_{};    ///< of `present_`
  std::optional<TimePoint> changeover_ends_at_;
  TimePoint keyed_at_{};
  std::uint32_t data_connection_{};               ///< ours
  std::unique_ptr<link::AeadProtection> opener_;  ///< io's own copy of the present data keys
  Roaming roaming_;                               ///< the patient's; holds the peer's address
  PathAnswers path_answers_;                      ///< the surgeon's
  std::uint64_t path_number_{};
  std::uint64_t greeted_{};  ///< association that waits for an answer to our greeting
  TimePoint greet_next_{};
  TimePoint greet_until_{};
  std::string told_;  ///< the last failure
  std::optional<TimePoint> told_at_;
  std::uint64_t foreign_{};
  std::uint64_t malformed_{};
};

/// With credentials or, for benches, without.
[[nodiscard]] std::unique_ptr<SessionEndpoint> make_session_endpoint(
    const DtlsSessionConfig& config, const Credentials* credentials);

}  // namespace palp::io
