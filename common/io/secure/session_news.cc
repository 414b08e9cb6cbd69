#include "common/io/secure/session_news.h"

#include "common/io/secure/dtls_failure.h"

namespace palp::io {

PeerIdentity identity_of(const link::Established& session, const SessionEndpoint& endpoint) {
  return {session.session_id, session.peer_git, endpoint.proof(), endpoint.fingerprint()};
}

std::optional<std::string> refusal_text(const link::Refused& refused,
                                        bool unanswered,
                                        const std::optional<RelayMember>& relay) {
  if (!unanswered || !relay) return refused.text;
  if (!relay->both_are_in()) return std::nullopt;
  return silence_in_room(relay->relay().to_string());
}

std::string session_sentence(link::Role role,
                             const Endpoint& peer,
                             const link::Established& session,
                             const std::string& proof) {
  const std::string name = role == link::Role::Surgeon ? "the patient site" : "the surgeon site";
  return "session with " + name + " at " + peer.to_string() +
         (session.peer_git.empty() ? "" : ", its build " + session.peer_git) +
         (proof.empty() ? "" : ", proven by " + proof);
}

}  // namespace palp::io
