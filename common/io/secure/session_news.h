#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/secure/relay_member.h"
#include "common/io/secure/session_endpoint.h"
#include "common/link/session.h"

namespace palp::io {

/// Who the peer of a session is, as far as it has shown that.
struct PeerIdentity {
  std::uint64_t session_id{};  ///< 0: there is none yet
  std::string build;           ///< git commit that it names; empty: none
  std::string name;            ///< proven, for people; empty: nothing was proven
  std::string fingerprint;     ///< SHA-256 of its certificate, hexadecimal; empty: it showed none
};
[[nodiscard]] PeerIdentity identity_of(const link::Established& session,
                                       const SessionEndpoint& endpoint);

/// What people are told of sessions.
struct SessionNews {
  enum class Kind : std::uint8_t { Established, Refused, Closed, Moved };
  Kind kind{};
  bool final{};  ///< refused, and there will never be a session with these settings
  TimePoint at{};
  Endpoint peer;
  std::string sentence;
  PeerIdentity identity;  ///< of the newest session
};

/// Why there is no session; nullopt: where both meet at a relay, that has said why nobody answers.
/// `unanswered`: the refusal is this site's own, for want of an answer.
[[nodiscard]] std::optional<std::string> refusal_text(const link::Refused& refused,
                                                      bool unanswered,
                                                      const std::optional<RelayMember>& relay);
/// Of an Established one, told by a site of that role: with whom, and what that was proven by.
[[nodiscard]] std::string session_sentence(link::Role role,
                                           const Endpoint& peer,
                                           const link::Established& session,
                                           const std::string& proof);

}  // namespace palp::io
