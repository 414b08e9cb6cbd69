#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "common/io/net/datagram_socket.h"
#include "common/io/net/endpoint.h"

/// What tests of the relay say and hear through sockets of their own.
namespace palp::netem {

using io::DatagramSocket;
using io::monotonic_now;
using io::OutgoingDatagram;
using io::ReceivedDatagram;

/// Of every wait.
inline constexpr Duration kDeadline = std::chrono::seconds{10};
inline const io::Endpoint kAnyPort = *io::resolve_endpoint("127.0.0.1:0");

inline std::vector<std::byte> saying(std::uint32_t number) {
  std::vector<std::byte> datagram(100);
  std::memcpy(datagram.data(), &number, sizeof number);
  return datagram;
}

struct Heard {
  std::vector<std::uint32_t> numbers;
  io::Endpoint from;
};

inline void hear(DatagramSocket& socket, Heard& heard) {
  for (auto got = socket.receive(); !got.empty(); got = socket.receive()) {
    for (const ReceivedDatagram& datagram : got) {
      std::uint32_t number = 0;
      std::memcpy(&number, datagram.bytes.data(), sizeof number);
      heard.numbers.push_back(number);
    }
    heard.from = socket.sender_of_last();
  }
}

}  // namespace palp::netem
