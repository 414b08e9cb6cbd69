#include "common/io/net/media_door.h"

#include <system_error>
#include <utility>

#include "common/io/net/media_wait.h"
#include "common/io/net/udp_socket.h"

namespace palp::io {

bool MediaDoor::take(MediaDoor* door,
                     std::span<const std::byte> datagram,
                     const Endpoint& from,
                     TimePoint now) {
  if (datagram.empty() || datagram[0] != kMediaFirstByte) return false;
  if (door != nullptr) (void)door->heard.try_emplace(datagram, from, now);
  return true;
}

void MediaDoor::serve(int listening, const Endpoint& local) {
  SideDatagram letter;
  for (std::size_t i = 0; i < kDatagrams && letters.try_dequeue(letter); ++i) {
    (void)::sendto(listening,
                   letter.bytes.data(),
                   letter.size,
                   MSG_DONTWAIT | MSG_NOSIGNAL,
                   letter.from.address(),
                   letter.from.size());
  }
  Endpoint peer;
  if (!wanted.try_dequeue(peer)) return;
  share_port(listening, true);  // only as long as it takes
  try {
    (void)ways.try_enqueue(std::make_unique<DatagramSocket>(DatagramSocket::sharing(local, peer)));
  } catch (const std::system_error&) {
    // It is asked for again.
  }
  share_port(listening, false);
}

}  // namespace palp::io
