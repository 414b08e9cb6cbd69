#include "common/io/net/udp_socket.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <netinet/ip.h>
#include <sys/socket.h>
#include <time.h>

#include "common/io/net/send_probe.h"
#include "common/io/process/system_text.h"
#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

constexpr std::size_t kBatch = 64;             ///< datagrams to a system call
constexpr int kErrorsPerTickMax = 8;           ///< more ICMP errors wait for the next tick
constexpr int kExpeditedForwarding = 46 << 2;  ///< TOS byte of DSCP EF, RFC 3246
constexpr Duration kStampAgeMax = std::chrono::milliseconds{100};

void set_option(int socket, int level, int name, int value) noexcept {
  (void)setsockopt(socket, level, name, &value, sizeof value);
}

/// Comfort, not conditions: a kernel that refuses one still carries datagrams.
void set_options(int socket, int family, const UdpSocketConfig& config) noexcept {
  set_option(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  ask_receive_buffer(socket, config.receive_buffer);
  mark_datagrams(socket, family, kExpeditedForwarding);
  // PROBE sets "don't fragment" without believing ICMP, which anybody can forge, on the path's MTU.
  if (family == AF_INET6) {
    set_option(socket, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_PROBE);
  }
  set_option(socket, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_PROBE);
}

Duration span_of(const timespec& stamp) noexcept {
  return std::chrono::seconds{stamp.tv_sec} + std::chrono::nanoseconds{stamp.tv_nsec};
}

/// Errors of the path, of earlier datagrams: reported once by whatever call comes next.
bool is_path_error(int error) noexcept {
  return error == ECONNREFUSED || error == EHOSTUNREACH || error == ENETUNREACH ||
         error == EHOSTDOWN || error == ENETDOWN || error == ENOPROTOOPT || error == EPROTO;
}

}  // namespace

void ask_receive_buffer(int socket, int bytes) noexcept {
  set_option(socket, SOL_SOCKET, SO_RCVBUF, bytes);
  set_option(socket, SOL_SOCKET, SO_RCVBUFFORCE, bytes);
}

void mark_datagrams(int socket, int family, int traffic_class) noexcept {
  if (family == AF_INET6) set_option(socket, IPPROTO_IPV6, IPV6_TCLASS, traffic_class);
  set_option(socket, IPPROTO_IP, IP_TOS, traffic_class);
}

void share_port(int socket, bool on) noexcept {
  set_option(socket, SOL_SOCKET, SO_REUSEPORT, on ? 1 : 0);
}

/// Room for one recvmmsg. What was taken but not handed over waits here, also over ticks.
struct UdpSocket::Batch {
  struct alignas(cmsghdr) Control {
    std::array<std::byte, CMSG_SPACE(sizeof(timespec)) + 64> bytes;
  };

  Batch() noexcept {
    for (std::size_t at = 0; at < kBatch; ++at) {
      blocks[at] = {.iov_base = buffers[at].data(), .iov_len = buffers[at].size()};
      messages[at].msg_hdr.msg_iov = &blocks[at];
      messages[at].msg_hdr.msg_iovlen = 1;
      messages[at].msg_hdr.msg_control = controls[at].bytes.data();
      messages[at].msg_hdr.msg_controllen = sizeof(Control);
    }
  }

  /// The kernel has shortened this field to what it wrote, in those that it filled.
  void prepare() noexcept {
    for (mmsghdr& message : std::span{messages}.first(size)) {
      message.msg_hdr.msg_controllen = sizeof(Control);
    }
    size = 0;
    next = 0;
  }

  [[nodiscard]] std::optional<Duration> stamp_of(std::size_t at) noexcept {
    msghdr& header = messages[at].msg_hdr;
    for (cmsghdr* one = CMSG_FIRSTHDR(&header); one != nullptr; one = CMSG_NXTHDR(&header, one)) {
      if (one->cmsg_level == SOL_SOCKET && one->cmsg_type == SCM_TIMESTAMPNS) {
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(one), sizeof stamp);
        return span_of(stamp);
      }
    }
    return std::nullopt;
  }

  std::array<std::array<std::byte, link::kDatagramSizeMax>, kBatch> buffers{};
  std::array<Control, kBatch> controls{};
  std::array<iovec, kBatch> blocks{};
  std::array<mmsghdr, kBatch> messages{};
  std::size_t size{};    ///< datagrams in the batch
  std::size_t next{};    ///< the first not handed over
  TimePoint taken_at{};  ///< monotonic and wall clock when the kernel gave the batch
  Duration wall_clock{};
};

UdpSocket::UdpSocket(Descriptor socket, const Endpoint& peer, SideInbox& inbox)
    : socket_{std::move(socket)}, peer_{peer}, inbox_{inbox}, batch_{std::make_unique<Batch>()} {}

UdpSocket::~UdpSocket() = default;

Result<std::unique_ptr<UdpSocket>> UdpSocket::connect(const Endpoint& local,
                                                      const Endpoint& peer,
                                                      SideInbox& inbox,
                                                      const UdpSocketConfig& config) {
  Descriptor socket{
      ::socket(peer.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_UDP)};
  if (!socket.valid()) {
    return fail("cannot open a UDP socket: " + system_text(errno));
  }
  set_options(socket.number(), peer.family(), config);
  share_port(socket.number(), true);
  if (::bind(socket.number(), local.address(), local.size()) != 0) {
    return fail("cannot use " + local.to_string() + ": " + system_text(errno));
  }
  // At once: until it is connected this socket takes everybody's datagrams of its port.
  if (::connect(socket.number(), peer.address(), peer.size()) != 0) {
    return fail("cannot connect to " + peer.to_string() + ": " + system_text(errno));
  }
  return std::unique_ptr<UdpSocket>{new UdpSocket{std::move(socket), peer, inbox}};
}

bool UdpSocket::send(std::span<const std::byte> datagram, TimePoint now) noexcept {
  for (std::size_t at = 0; at < Detour::kPlaces; ++at) {
    const Endpoint* to = detour_.spend(at, datagram.size(), now);
    if (to != nullptr && ::sendto(socket_.number(),
                                  datagram.data(),
                                  datagram.size(),
                                  MSG_DONTWAIT,
                                  to->address(),
                                  to->size()) >= 0) {
      ++inbox_.counting.detoured;
    }
  }
  // A second time, because an error of the path belongs to an earlier datagram and has kept this
  // one from leaving.
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (::send(socket_.number(), datagram.data(), datagram.size(), MSG_DONTWAIT) >= 0) {
      ++inbox_.counting.sent;
      return true;
    }
    if (!is_path_error(errno)) {
      break;
    }
    ++inbox_.counting.path_errors;
  }
  ++inbox_.counting.unsent;
  return false;
}

void UdpSocket::begin_tick(TimePoint now) noexcept {
  tick_ = now;
  taken_ = 0;
  errors_ = 0;
  drained_ = false;
  detour_.begin_tick(now);
  inbox_.peer_heard_at = detour_.straight_at();
  inbox_.counts.put(inbox_.counting);
}

bool UdpSocket::fetch() noexcept {
  Batch& batch = *batch_;
  while (!drained_ && errors_ < kErrorsPerTickMax) {
    batch.prepare();
    const int got = ::recvmmsg(
        socket_.number(), batch.messages.data(), kBatch, MSG_DONTWAIT | MSG_TRUNC, nullptr);
    if (got > 0) {
      batch.size = static_cast<std::size_t>(got);
      drained_ = batch.size < kBatch;
      timespec wall{};
      batch.taken_at = SteadyClock{}.now();
      clock_gettime(CLOCK_REALTIME, &wall);
      batch.wall_clock = span_of(wall);
      return true;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      drained_ = true;
    } else {
      ++errors_;
      ++inbox_.counting.path_errors;
    }
  }
  return false;
}

std::optional<link::Datagram> UdpSocket::receive(
    std::span<std::byte, link::kDatagramSizeMax> buffer, TimePoint now) noexcept {
  if (now != tick_) {
    begin_tick(now);
  }
  Batch& batch = *batch_;
  SocketCounts& counting = inbox_.counting;
  while (taken_ < link::kDatagramsPerTickMax) {
    if (batch.next == batch.size && !fetch()) {
      return take_detour(buffer, now);
    }
    const std::size_t at = batch.next++;
    ++taken_;
    ++counting.received;
    const std::size_t size = batch.messages[at].msg_len;
    const std::span<const std::byte> bytes{batch.buffers[at].data(),
                                           std::min(size, link::kDatagramSizeMax)};
    TimePoint arrived_at = std::min(batch.taken_at, now);
    const std::optional<Duration> stamp = batch.stamp_of(at);
    const Duration age = stamp ? batch.wall_clock - *stamp : Duration{-1};
    if (age >= Duration{0} && age <= kStampAgeMax) {
      arrived_at = std::min(batch.taken_at - age, now);
    } else {
      ++counting.without_stamp;
    }
    if (size > 0 && bytes.front() == kDataFirstByte) {
      straight_ = true;
      std::memcpy(buffer.data(), bytes.data(), bytes.size());
      return link::Datagram{.size = size, .arrived_at = arrived_at};
    }
    const bool fits = size > 0 && size <= link::kDatagramSizeMax;
    if (fits && inbox_.datagrams.try_emplace(bytes, peer_, arrived_at)) {
      ++counting.set_aside;
    } else {
      ++counting.dropped;
    }
  }
  return std::nullopt;
}

std::optional<link::Datagram> UdpSocket::take_detour(
    std::span<std::byte, link::kDatagramSizeMax> buffer, TimePoint now) noexcept {
  while (taken_ < link::kDatagramsPerTickMax) {
    const SideDatagram* waiting = inbox_.detours.peek();
    if (waiting == nullptr) break;
    const Detour::Fate fate = detour_.fate(waiting->from, waiting->arrived_at, now);
    if (fate == Detour::Fate::Wait) break;
    ++taken_;
    const link::Datagram taken{.size = waiting->size,
                               .arrived_at = std::min(waiting->arrived_at, now)};
    if (fate == Detour::Fate::Take) {
      // Unless it was proven meanwhile.
      if (!(waiting->from == peer_)) detour_.heard(waiting->from, waiting->size);
      straight_ = false;
      std::ranges::copy(waiting->datagram(), buffer.begin());
    }
    (void)inbox_.detours.pop();
    if (fate == Detour::Fate::Take) return taken;
  }
  return std::nullopt;
}

void UdpSocket::recognised(TimePoint now) noexcept {
  if (straight_) detour_.heard_straight(now);
}

void UdpSocket::warm_up() noexcept {
  Batch& batch = *batch_;
  if (batch.next < batch.size) return;
  batch.prepare();
  batch.size = 1;  // the peek shortens a field of the first message, which is to be put right again
  batch.next = 1;
  const ssize_t got =
      ::recvmsg(socket_.number(), &batch.messages[0].msg_hdr, MSG_DONTWAIT | MSG_PEEK | MSG_TRUNC);
  if (got < 0 && is_path_error(errno)) ++inbox_.counting.path_errors;
  const std::byte nothing{};
  if (::send(socket_.number(), &nothing, sizeof nothing, MSG_DONTWAIT | kSendProbe) < 0 &&
      is_path_error(errno)) {
    ++inbox_.counting.path_errors;
  }
}

std::optional<UdpSocket::Stranger> UdpSocket::take_early(std::span<std::byte> buffer) noexcept {
  sockaddr_storage from{};
  for (int attempt = 0; attempt < kErrorsPerTickMax; ++attempt) {
    socklen_t length = sizeof from;
    const ssize_t got = ::recvfrom(socket_.number(),
                                   buffer.data(),
                                   buffer.size(),
                                   MSG_DONTWAIT | MSG_TRUNC,
                                   reinterpret_cast<sockaddr*>(&from),
                                   &length);
    if (got >= 0) {
      return Stranger{.from = Endpoint{&from, length}, .size = static_cast<std::size_t>(got)};
    }
    if (!is_path_error(errno)) {
      break;
    }
  }
  return std::nullopt;
}

Endpoint UdpSocket::local() const noexcept {
  sockaddr_storage name{};
  socklen_t length = sizeof name;
  if (getsockname(socket_.number(), reinterpret_cast<sockaddr*>(&name), &length) != 0) {
    return {};
  }
  return {&name, length};
}

}  // namespace palp::io
