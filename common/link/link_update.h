#pragma once

#include <cstdint>
#include <memory>

#include "common/core/device_facts.h"
#include "common/link/packet_protection.h"
#include "common/link/transport.h"

namespace palp::link {

/// What io hands to rt: a connected way, its protection, or both; and what rt hands back to be
/// freed. Null: keep the present one. Moves between threads, owned by one at a time.
struct LinkUpdate {
  std::unique_ptr<Transport> transport;
  std::unique_ptr<PacketProtection> protection;
  std::uint32_t send_connection{};     ///< given out by the peer
  std::uint32_t receive_connection{};  ///< given out by us
  std::uint64_t
      session_id{};  ///< another one: a new session, all starts anew; 0: the session ended
  DeviceFacts peer_devices{};  ///< of a new session's other site
  /// Only for the session that is there: where it has ended meanwhile, all comes back unused.
  bool continues{};
};

}  // namespace palp::link
