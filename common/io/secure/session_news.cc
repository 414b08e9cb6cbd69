#include "common/io/secure/session_news.h"

namespace palp::io {

PeerIdentity identity_of(const link::Established& session, const SessionEndpoint& endpoint) {
  return {session.session_id, session.peer_git, endpoint.proof(), endpoint.fingerprint()};
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
