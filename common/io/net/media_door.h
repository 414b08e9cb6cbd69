#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/core/spsc_queue.h"
#include "common/io/net/datagram_socket.h"
#include "common/io/net/endpoint.h"
#include "common/io/net/side_inbox.h"
#include "common/link/traffic_keys.h"

namespace palp::io {

/// Of a session, for its video.
struct MediaSession {
  std::uint64_t session_id{};           ///< 0: the session is over
  std::optional<link::PlaneKeys> keys;  ///< none: a session that seals nothing
  Endpoint peer;                        ///< where force goes
};

/// Where io and the thread of the video meet. What comes for video to the listening socket goes to
/// that thread unread; a socket of the same port to an address that it has proven is made by io,
/// who alone has the port. Where a queue is full, what is new is left out: all of it is repeated.
/// Outlives the server.
struct MediaDoor {
  static constexpr std::size_t kDatagrams = 64;

  SpscQueue<SideDatagram> heard{kDatagrams};           ///< writer: io, reader: video
  SpscQueue<MediaSession> sessions{16};                ///< writer: io, reader: video
  SpscQueue<SideDatagram> letters{kDatagrams};         ///< to `from`; writer: video, reader: io
  SpscQueue<Endpoint> wanted{4};                       ///< writer: video, reader: io
  SpscQueue<std::unique_ptr<DatagramSocket>> ways{4};  ///< writer: io, reader: video
};

/// Marks of every datagram of video (WIRE.md): version 8, type 5.
inline constexpr std::byte kMediaFirstByte{0x85};

}  // namespace palp::io
