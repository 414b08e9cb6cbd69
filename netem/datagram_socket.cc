#include "netem/datagram_socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "common/link/transport.h"

namespace palp::netem {
namespace {

constexpr unsigned kBatch = 64;
/// Longer than the channel takes, so that what is too long is seen to be.
constexpr std::size_t kBufferSize = link::kDatagramSizeMax + 1;
constexpr int kReceiveBuffer = 4 << 20;  ///< [bytes], 20 ms at 200,000 datagrams/s with overhead
/// An older stamp means that the wall clock was stepped.
constexpr Duration kStampAgeMax = std::chrono::milliseconds{100};

Duration read_clock(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec};
}

/// The kernel stamps on the wall clock; both clocks read now carry the stamp over.
TimePoint arrival_of(msghdr& header, Duration monotonic, Duration wall) noexcept {
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
    const Duration age =
        wall - (std::chrono::seconds{stamp.tv_sec} + std::chrono::nanoseconds{stamp.tv_nsec});
    if (age >= Duration{} && age <= kStampAgeMax) return TimePoint{monotonic - age};
  }
  return TimePoint{monotonic};
}

[[noreturn]] void cannot(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

int open_socket(const io::Endpoint& of) {
  const int descriptor = ::socket(of.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) cannot("cannot open a UDP socket");
  return descriptor;
}

}  // namespace

TimePoint monotonic_now() noexcept { return TimePoint{read_clock(CLOCK_MONOTONIC)}; }

struct DatagramSocket::Batch {
  Batch() {
    for (unsigned i = 0; i < kBatch; ++i) {
      parts[i] = {buffers[i].data(), kBufferSize};
      msghdr& header = headers[i].msg_hdr;
      header.msg_iov = &parts[i];
      header.msg_iovlen = 1;
      header.msg_name = &senders[i];
      header.msg_control = controls[i].data();
    }
  }
  std::array<mmsghdr, kBatch> headers{};
  std::array<iovec, kBatch> parts{};
  std::array<sockaddr_storage, kBatch> senders{};
  alignas(cmsghdr) std::array<std::array<char, 64>, kBatch> controls{};
  std::array<std::array<std::byte, kBufferSize>, kBatch> buffers{};
  std::array<ReceivedDatagram, kBatch> datagrams{};
};

DatagramSocket::DatagramSocket(int descriptor)
    : descriptor_{descriptor}, batch_{std::make_unique<Batch>()} {
  const int on = 1;
  ::setsockopt(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  // The privileged call goes beyond the system's limit, the plain one up to it: either will do.
  if (::setsockopt(
          descriptor_, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBuffer, sizeof kReceiveBuffer) != 0) {
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  }
}

DatagramSocket::DatagramSocket(DatagramSocket&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)},
      batch_{std::move(other.batch_)},
      errors_{other.errors_} {}

DatagramSocket::~DatagramSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

DatagramSocket DatagramSocket::bound(const io::Endpoint& local) {
  DatagramSocket socket{open_socket(local)};
  if (::bind(socket.descriptor_, local.address(), local.size()) != 0) {
    cannot("cannot listen on " + local.to_string());
  }
  return socket;
}

DatagramSocket DatagramSocket::connected(const io::Endpoint& peer) {
  DatagramSocket socket{open_socket(peer)};
  if (::connect(socket.descriptor_, peer.address(), peer.size()) != 0) {
    cannot("cannot forward to " + peer.to_string());
  }
  return socket;
}

io::Endpoint DatagramSocket::local() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  // The sockets API takes every family through this one type.
  if (::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    cannot("cannot read an address");
  }
  return {&address, size};
}

std::span<const ReceivedDatagram> DatagramSocket::receive() noexcept {
  Batch& batch = *batch_;
  for (mmsghdr& header : batch.headers) {
    header.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
    header.msg_hdr.msg_controllen = batch.controls[0].size();
  }
  const int got = ::recvmmsg(descriptor_, batch.headers.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (got < 0) {
    if (errno != EAGAIN && errno != EINTR) ++errors_;
    return {};
  }
  const Duration monotonic = read_clock(CLOCK_MONOTONIC);
  const Duration wall = read_clock(CLOCK_REALTIME);
  const auto count = static_cast<std::size_t>(got);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = std::min<std::size_t>(batch.headers[i].msg_len, kBufferSize);
    batch.datagrams[i] = {std::span{batch.buffers[i]}.first(size),
                          arrival_of(batch.headers[i].msg_hdr, monotonic, wall),
                          io::Endpoint{&batch.senders[i], batch.headers[i].msg_hdr.msg_namelen}};
  }
  return std::span{batch.datagrams}.first(count);
}

bool DatagramSocket::send(std::span<const std::byte> datagram,
                          const std::optional<io::Endpoint>& to) noexcept {
  // An error may be the answer to an earlier datagram; the first call only fetches it, so the
  // datagram at hand gets a second one.
  for (int attempt = 0; attempt < 2; ++attempt) {
    const ssize_t sent = ::sendto(descriptor_,
                                  datagram.data(),
                                  datagram.size(),
                                  MSG_DONTWAIT | MSG_NOSIGNAL,
                                  to ? to->address() : nullptr,
                                  to ? to->size() : 0);
    if (sent >= 0) return true;
    ++errors_;
    if (errno != ECONNREFUSED) return false;
  }
  return false;
}

}  // namespace palp::netem
