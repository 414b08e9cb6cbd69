#include "common/io/net/datagram_socket.h"

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

#include "common/io/net/send_probe.h"
#include "common/io/net/udp_socket.h"
#include "common/link/transport.h"

namespace palp::io {
namespace {

constexpr unsigned kMessagesMax = kDatagramBatch;
constexpr int kKernelBuffer = 4 << 20;  ///< [bytes], 20 ms at 200,000 datagrams/s with overhead
/// An older stamp means that the wall clock was stepped.
constexpr Duration kStampOldest = std::chrono::milliseconds{100};

Duration read_clock(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec};
}

/// What the kernel says about a datagram. It stamps on the wall clock; both clocks read now carry
/// the stamp over.
void read_controls(msghdr& header, Duration monotonic, Duration wall, ReceivedDatagram& datagram) {
  datagram.arrived_at = TimePoint{monotonic};
  datagram.tos = 0;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
      const Duration age =
          wall - (std::chrono::seconds{stamp.tv_sec} + std::chrono::nanoseconds{stamp.tv_nsec});
      const bool stepped = age < Duration{} || age > kStampOldest;
      if (!stepped) datagram.arrived_at = TimePoint{monotonic - age};
    } else if (part->cmsg_level == IPPROTO_IP && part->cmsg_type == IP_TOS) {
      std::memcpy(&datagram.tos, CMSG_DATA(part), sizeof datagram.tos);
    } else if (part->cmsg_level == IPPROTO_IPV6 && part->cmsg_type == IPV6_TCLASS) {
      int traffic_class = 0;
      std::memcpy(&traffic_class, CMSG_DATA(part), sizeof traffic_class);
      datagram.tos = static_cast<std::uint8_t>(traffic_class);
    }
  }
}

/// The kernel only reads what is sent; its interface has no const.
template <class Sent>
Sent* unguarded(const Sent* sent) noexcept {
  return const_cast<Sent*>(sent);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

[[noreturn]] void cannot(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

int open_socket(const Endpoint& of) {
  const int descriptor = ::socket(of.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) cannot("cannot open a UDP socket");
  const int on = 1;
  ::setsockopt(descriptor, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  // Each family has one of the two.
  ::setsockopt(descriptor, IPPROTO_IP, IP_RECVTOS, &on, sizeof on);
  ::setsockopt(descriptor, IPPROTO_IPV6, IPV6_RECVTCLASS, &on, sizeof on);
  // The privileged call goes beyond the system's limit, the plain one up to it: either will do.
  const int size = kKernelBuffer;
  if (::setsockopt(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, &size, sizeof size) != 0) {
    ::setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  }
  return descriptor;
}

/// A socket of IPv6 speaks IPv4 as well, to addresses made for that.
bool speaks_ipv6(const Endpoint& to) noexcept {
  if (to.family() != AF_INET6) return false;
  return !IN6_IS_ADDR_V4MAPPED(&reinterpret_cast<const sockaddr_in6*>(to.address())->sin6_addr);
}

}  // namespace

TimePoint monotonic_now() noexcept { return TimePoint{read_clock(CLOCK_MONOTONIC)}; }

Duration wall_now() noexcept { return read_clock(CLOCK_REALTIME); }

struct DatagramSocket::Batch {
  /// Each buffer a byte longer than the longest datagram, so that what is too long is seen to be.
  explicit Batch(std::size_t datagram_max)
      : buffer_size{datagram_max + 1},
        buffers{std::make_unique<std::byte[]>(kMessagesMax * buffer_size)} {
    for (unsigned i = 0; i < kMessagesMax; ++i) {
      parts[i] = {buffers.get() + i * buffer_size, buffer_size};
      msghdr& header = headers[i].msg_hdr;
      header.msg_iov = &parts[i];
      header.msg_iovlen = 1;
      header.msg_name = &senders[i];
      header.msg_control = controls[i].data();
      out_headers[i].msg_hdr.msg_iov = &out_parts[i];
      out_headers[i].msg_hdr.msg_iovlen = 1;
    }
  }
  std::size_t buffer_size;  ///< [bytes]
  std::unique_ptr<std::byte[]> buffers;
  std::array<mmsghdr, kMessagesMax> headers{};
  std::array<iovec, kMessagesMax> parts{};
  std::array<sockaddr_storage, kMessagesMax> senders{};
  alignas(cmsghdr) std::array<std::array<char, 64>, kMessagesMax> controls{};
  std::array<ReceivedDatagram, kMessagesMax> datagrams{};
  std::size_t last{};  ///< of `senders`
  std::array<mmsghdr, kMessagesMax> out_headers{};
  std::array<iovec, kMessagesMax> out_parts{};
  alignas(
      cmsghdr) std::array<std::array<char, CMSG_SPACE(sizeof(int))>, kMessagesMax> out_controls{};
};

DatagramSocket::DatagramSocket(int descriptor, std::size_t datagram_max)
    : descriptor_{descriptor}, batch_{std::make_unique<Batch>(datagram_max)} {}

DatagramSocket::DatagramSocket(DatagramSocket&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)},
      batch_{std::move(other.batch_)},
      peer_ipv6_{other.peer_ipv6_},
      errors_{other.errors_} {}

DatagramSocket& DatagramSocket::operator=(DatagramSocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(batch_, other.batch_);
  std::swap(peer_ipv6_, other.peer_ipv6_);
  std::swap(errors_, other.errors_);
  return *this;
}

DatagramSocket::~DatagramSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

DatagramSocket DatagramSocket::bound(const Endpoint& local, std::size_t datagram_max) {
  DatagramSocket socket{open_socket(local), datagram_max};
  if (::bind(socket.descriptor_, local.address(), local.size()) != 0) {
    cannot("cannot listen on " + local.to_string());
  }
  return socket;
}

DatagramSocket DatagramSocket::connected(const Endpoint& peer, std::size_t datagram_max) {
  DatagramSocket socket{open_socket(peer), datagram_max};
  socket.connect(peer);
  return socket;
}

DatagramSocket DatagramSocket::sharing(const Endpoint& local,
                                       const Endpoint& peer,
                                       std::size_t datagram_max) {
  DatagramSocket socket{open_socket(peer), datagram_max};
  share_port(socket.descriptor_, true);
  if (::bind(socket.descriptor_, local.address(), local.size()) != 0) {
    cannot("cannot use " + local.to_string());
  }
  socket.connect(peer);
  return socket;
}

void DatagramSocket::reconnect(const Endpoint& peer) {
  const int former = std::exchange(descriptor_, open_socket(peer));
  ::close(former);
  connect(peer);
}

void DatagramSocket::connect(const Endpoint& peer) {
  if (::connect(descriptor_, peer.address(), peer.size()) != 0) {
    cannot("cannot forward to " + peer.to_string());
  }
  peer_ipv6_ = speaks_ipv6(peer);
}

Endpoint DatagramSocket::local() const {
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
  const int got =
      ::recvmmsg(descriptor_, batch.headers.data(), kMessagesMax, MSG_DONTWAIT, nullptr);
  if (got < 0) {
    if (errno != EAGAIN && errno != EINTR) ++errors_;
    return {};
  }
  const Duration monotonic = read_clock(CLOCK_MONOTONIC);
  const Duration wall = read_clock(CLOCK_REALTIME);
  const auto count = static_cast<std::size_t>(got);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = std::min<std::size_t>(batch.headers[i].msg_len, batch.buffer_size);
    batch.datagrams[i].bytes = {batch.buffers.get() + i * batch.buffer_size, size};
    read_controls(batch.headers[i].msg_hdr, monotonic, wall, batch.datagrams[i]);
  }
  if (count > 0) batch.last = count - 1;
  return std::span{batch.datagrams}.first(count);
}

Endpoint DatagramSocket::sender_of_last() const noexcept { return sender_of(batch_->last); }

Endpoint DatagramSocket::sender_of(std::size_t index) const noexcept {
  return {&batch_->senders[index], batch_->headers[index].msg_hdr.msg_namelen};
}

std::size_t DatagramSocket::send(std::span<const OutgoingDatagram> datagrams,
                                 const Endpoint* to) noexcept {
  Batch& batch = *batch_;
  const std::size_t count = std::min(datagrams.size(), kDatagramBatch);
  const bool ipv6 = to != nullptr ? speaks_ipv6(*to) : peer_ipv6_;
  for (std::size_t i = 0; i < count; ++i) {
    batch.out_parts[i] = {unguarded(datagrams[i].bytes.data()), datagrams[i].bytes.size()};
    msghdr& header = batch.out_headers[i].msg_hdr;
    header.msg_name = to != nullptr ? unguarded(to->address()) : nullptr;
    header.msg_namelen = to != nullptr ? to->size() : 0;
    header.msg_control = nullptr;
    header.msg_controllen = 0;
    if (datagrams[i].tos == 0) continue;
    header.msg_control = batch.out_controls[i].data();
    header.msg_controllen = batch.out_controls[i].size();
    cmsghdr* part = CMSG_FIRSTHDR(&header);
    part->cmsg_level = ipv6 ? IPPROTO_IPV6 : IPPROTO_IP;
    part->cmsg_type = ipv6 ? IPV6_TCLASS : IP_TOS;
    part->cmsg_len = CMSG_LEN(sizeof(int));
    const int tos = datagrams[i].tos;
    std::memcpy(CMSG_DATA(part), &tos, sizeof tos);
  }
  std::size_t sent = 0;
  // An error may be the answer to an earlier datagram; such a call only fetches it, so the datagram
  // at hand gets a second one.
  bool again = true;
  for (std::size_t at = 0; at < count;) {
    const int went = ::sendmmsg(descriptor_,
                                batch.out_headers.data() + at,
                                static_cast<unsigned>(count - at),
                                MSG_DONTWAIT | MSG_NOSIGNAL);
    if (went > 0) {
      at += static_cast<std::size_t>(went);
      sent += static_cast<std::size_t>(went);
      again = true;
      continue;
    }
    ++errors_;
    if (errno == ECONNREFUSED && again) {
      again = false;
    } else {
      ++at;
      again = true;
    }
  }
  return sent;
}

void DatagramSocket::warm(const Endpoint* to) noexcept {
  std::byte nothing{};
  iovec part{&nothing, sizeof nothing};
  msghdr header{};
  header.msg_name = to != nullptr ? unguarded(to->address()) : nullptr;
  header.msg_namelen = to != nullptr ? to->size() : 0;
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (::sendmsg(descriptor_, &header, MSG_DONTWAIT | MSG_NOSIGNAL | kSendProbe) < 0) ++errors_;
}

bool DatagramSocket::send(std::span<const std::byte> datagram,
                          const std::optional<Endpoint>& to) noexcept {
  const OutgoingDatagram one{.bytes = datagram};
  return send({&one, 1}, to ? &*to : nullptr) == 1;
}

}  // namespace palp::io
