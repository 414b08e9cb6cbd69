#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/io/net/endpoint.h"
#include "common/io/process/descriptor.h"
#include "common/io/realtime/steady_clock.h"

/// Loopback sockets for tests: ports from the kernel, waits with a deadline.
namespace palp::io::test {

using Bytes = std::vector<std::byte>;

/// `size` bytes, the first as given, the others all alike.
inline Bytes bytes_of(std::uint8_t first, std::size_t size) {
  Bytes bytes(size, std::byte{0x5A});
  if (size > 0) {
    bytes[0] = std::byte{first};
  }
  return bytes;
}

/// Polls until `done` holds. @returns false: not within ten seconds.
inline bool wait_until(const std::function<bool()>& done) {
  const SteadyClock clock;
  const TimePoint deadline = clock.now() + std::chrono::seconds{10};
  while (!done()) {
    if (clock.now() > deadline) {
      return false;
    }
    std::this_thread::yield();
  }
  return true;
}

/// A UDP socket bound to `place`, or an invalid one where that is refused.
inline Descriptor bound_to(const Endpoint& place, bool shares) {
  Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  const int on = shares ? 1 : 0;
  (void)setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(socket.number(), place.address(), place.size()) != 0) {
    socket.close();
  }
  return socket;
}

/// Whether a process that is ready to share could take datagrams of `place`.
inline bool can_share(const Endpoint& place) { return bound_to(place, true).valid(); }

/// A plain blocking socket on 127.0.0.1: the other end, a stranger, a flooder.
class PlainSocket {
 public:
  explicit PlainSocket(std::uint16_t port = 0, bool shares = false)
      : socket_{bound_to(*resolve_endpoint("127.0.0.1:" + std::to_string(port)), shares)} {
    EXPECT_TRUE(socket_.valid());
  }
  [[nodiscard]] Endpoint local() const {
    sockaddr_storage name{};
    socklen_t length = sizeof name;
    EXPECT_EQ(::getsockname(socket_.number(), reinterpret_cast<sockaddr*>(&name), &length), 0);
    return {&name, length};
  }
  bool send_to(const Endpoint& to, std::span<const std::byte> bytes) {
    const ssize_t sent =
        ::sendto(socket_.number(), bytes.data(), bytes.size(), 0, to.address(), to.size());
    return sent == static_cast<ssize_t>(bytes.size());
  }
  /// Waits up to ten seconds.
  std::optional<Bytes> receive() {
    pollfd watched{.fd = socket_.number(), .events = POLLIN, .revents = 0};
    if (::poll(&watched, 1, 10'000) <= 0) {
      return std::nullopt;
    }
    Bytes bytes(70'000);
    const ssize_t got = ::recv(socket_.number(), bytes.data(), bytes.size(), 0);
    if (got < 0) {
      return std::nullopt;
    }
    bytes.resize(static_cast<std::size_t>(got));
    return bytes;
  }
  struct Taken {
    Endpoint from;
    Bytes bytes;
  };
  /// nullopt: none waits.
  std::optional<Taken> take() {
    Bytes bytes(2000);
    sockaddr_storage from{};
    socklen_t length = sizeof from;
    const ssize_t got = ::recvfrom(socket_.number(),
                                   bytes.data(),
                                   bytes.size(),
                                   MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&from),
                                   &length);
    if (got < 0) {
      return std::nullopt;
    }
    bytes.resize(static_cast<std::size_t>(got));
    return Taken{.from = {&from, length}, .bytes = std::move(bytes)};
  }
  [[nodiscard]] int descriptor() const noexcept { return socket_.number(); }
  void close() { socket_.close(); }

 private:
  Descriptor socket_;
};

}  // namespace palp::io::test
