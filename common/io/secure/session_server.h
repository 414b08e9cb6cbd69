#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/io/net/link_update_desk.h"
#include "common/io/net/media_door.h"
#include "common/io/net/udp_socket.h"
#include "common/io/secure/credentials.h"
#include "common/io/secure/session_news.h"
#include "common/link/session.h"
#include "common/link/transport.h"

namespace palp::io {

/// Puts something between a connected socket and the link, for good; called on the io thread.
using TransportWrap =
    std::function<std::unique_ptr<link::Transport>(std::unique_ptr<link::Transport>)>;

struct SessionServerConfig {
  link::SessionConfig session;
  HostAndPort address;  ///< patient: where to listen, port 0: any; surgeon: the patient site
  std::optional<HostAndPort> relay;  ///< where both meet instead; the patient's address may be none
  std::string room;                  ///< there: a name for RoomKey
  UdpSocketConfig socket;
  TransportWrap wrap_transport;      ///< empty: the link gets the socket itself
  int priority{};                    ///< SCHED_FIFO of the io thread, below rt's; 0: leave as it is
  const Credentials* credentials{};  ///< outlives the server; null: plain, for benches
  MediaDoor* media{};                ///< outlives the server; null: there is no video
  Duration rekey_after{std::chrono::hours{1}};  ///< age of keys that the surgeon replaces
};

/// Finds the peer and makes sessions, on a thread of its own (io): owns the listening socket,
/// drives link::Session, reads what rt set aside, and gives rt a connected socket and its
/// protection over the desk for each new session, new keys or a new way within one.
/// Thread: its maker's.
class SessionServer {
 public:
  /// Starts to listen or to call. `desk` outlives the server.
  /// @throws std::runtime_error with one sentence: `cannot listen on 127.0.0.1:9000: address
  /// already in use`, or a host that cannot be found.
  SessionServer(const SessionServerConfig& config, LinkUpdateDesk& desk);
  /// Closes.
  ~SessionServer();
  SessionServer(const SessionServer&) = delete;
  SessionServer& operator=(const SessionServer&) = delete;

  /// Address and port in use; the port is the kernel's choice where none was given.
  [[nodiscard]] Endpoint local() const;
  /// One at a time, in order; nullopt: none. Old ones are kept where nobody asks for long.
  [[nodiscard]] std::optional<SessionNews> news();
  /// What the connected sockets have seen, as of the last tick of rt.
  [[nodiscard]] SocketCounts socket_counts() const;
  /// What came to the listening port, or was set aside, and made no sense.
  [[nodiscard]] link::SessionCounters noise() const;
  /// Leaves the session, telling the peer why, and ends the io thread. Idempotent. rt keeps what
  /// it has.
  void close(const std::string& why);

 private:
  class Io;
  std::unique_ptr<Io> io_;
};

}  // namespace palp::io
