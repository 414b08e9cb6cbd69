#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/net/machine_check.h"
#include "common/io/secure/credentials.h"

/// How far the peer is, before a session.
namespace palp::io {

struct PathFacts {
  std::size_t asked{};
  std::vector<Duration> round_trips;  ///< of the questions that were answered
};

struct PathCheckConfig {
  std::size_t questions{10};                      ///< 256 at most
  Duration pause{std::chrono::milliseconds{50}};  ///< between two questions
  Duration patience{std::chrono::seconds{3}};     ///< then the last question counts as lost
};

/// Asks a patient site that runs at `peer`, in a session or not, for cookies: each is the first
/// word of a handshake and its answer, and leaves nothing behind there. `credentials` are a
/// surgeon's. Blocks. Refusal: the peer cannot be found, or there is no socket.
[[nodiscard]] Result<PathFacts> read_path(const HostAndPort& peer,
                                          const Credentials& credentials,
                                          const PathCheckConfig& config = {});

/// Whether both sites take each other's certificates: a whole handshake with the patient site at
/// `peer`, which no session follows; one that runs there goes on. Blocks, at the longest for
/// `patience`. Refusal: as of read_path().
[[nodiscard]] Result<MachineFinding> try_handshake(const HostAndPort& peer,
                                                   const Credentials& credentials,
                                                   Duration patience = std::chrono::seconds{10});

/// As read_path() of a relay: it answers everybody, and keeps nothing.
[[nodiscard]] Result<PathFacts> read_relay_path(const HostAndPort& relay,
                                                const PathCheckConfig& config = {});

/// What that means for a session.
enum class PathGoal : std::uint8_t { Peer, Relay };
[[nodiscard]] MachineFinding judge_path(const PathFacts& facts, PathGoal goal = PathGoal::Peer);

}  // namespace palp::io
