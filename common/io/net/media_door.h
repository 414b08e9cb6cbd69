#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

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
class MediaDoor {
 public:
  static constexpr std::size_t kDatagrams = 64;

  /// io: another session, or none any more.
  void begin(const MediaSession& session) { (void)sessions.try_enqueue(session); }
  /// io: what came to the listening socket; `door` null: nobody wants video. false: it is no video.
  [[nodiscard]] static bool take(MediaDoor* door,
                                 std::span<const std::byte> datagram,
                                 const Endpoint& from,
                                 TimePoint now);
  /// io: what the thread of the video cannot do. `listening`: the socket that has `local`.
  void serve(int listening, const Endpoint& local);

  SpscQueue<SideDatagram> heard{kDatagrams};           ///< writer: io, reader: video
  SpscQueue<MediaSession> sessions{16};                ///< writer: io, reader: video
  SpscQueue<SideDatagram> letters{kDatagrams};         ///< to `from`; writer: video, reader: io
  SpscQueue<Endpoint> wanted{4};                       ///< writer: video, reader: io
  SpscQueue<std::unique_ptr<DatagramSocket>> ways{4};  ///< writer: io, reader: video
};

}  // namespace palp::io
