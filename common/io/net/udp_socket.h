#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/net/detour.h"
#include "common/io/net/endpoint.h"
#include "common/io/net/side_inbox.h"
#include "common/io/process/descriptor.h"
#include "common/link/transport.h"

namespace palp::io {

struct UdpSocketConfig {
  /// [bytes] asked of the kernel, which may give less: 20 ms of 150,000 small datagrams a second.
  int receive_buffer{4 << 20};
};

/// With the right to it also above what the system allows everybody.
void ask_receive_buffer(int socket, int bytes) noexcept;

/// What `socket` sends bears this TOS byte. A socket of IPv6 that is bound to any address serves
/// peers of IPv4 too, so both kinds of its datagrams are marked.
void mark_datagrams(int socket, int family, int traffic_class) noexcept;

/// While it is `on`, further sockets of the same user that permit it too may have the port of this
/// one: SO_REUSEPORT asks whose they are. SO_REUSEADDR would let in any user of the machine, and
/// with it who swallows all that comes for the port.
void share_port(int socket, bool on) noexcept;

/// A connected, non-blocking UDP socket: the kernel lets through what the peer's address sent.
/// Datagrams of type data go to the caller, all others into the inbox; both count against the
/// budget of a tick. Where the peer's address is silent, telegrams that io took from others come
/// after them, and what is sent goes there too, within the bounds of Detour. ICMP errors are
/// counted and never end anything. Thread: made by io, then rt's. Allocates nothing after
/// construction.
class UdpSocket final : public link::Transport {
 public:
  /// Bound to `local` (port 0: any), connected to `peer`. `inbox` outlives receive(), not the
  /// socket's destruction. The local port may be shared with a socket of this user that
  /// permits it.
  [[nodiscard]] static Result<std::unique_ptr<UdpSocket>> connect(const Endpoint& local,
                                                                  const Endpoint& peer,
                                                                  SideInbox& inbox,
                                                                  const UdpSocketConfig& config);
  ~UdpSocket() override;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override;
  /// While `now` stays the same the kernel is asked until it has no more, and at most
  /// kDatagramsPerTickMax are taken; what remains waits for the next `now`. Arrival is the
  /// kernel's stamp, never after `now`.
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override;
  /// Where it came over the peer's own address, that one delivers.
  void recognised(TimePoint now) noexcept override;
  void warm_up() noexcept override;

  /// io, before rt gets the socket: between bind and connect the kernel gave it datagrams of
  /// strangers. Takes one that waits, with its sender; nullopt: none left.
  struct Stranger {
    Endpoint from;
    std::size_t size{};  ///< [bytes]; over buffer size: cut off
  };
  [[nodiscard]] std::optional<Stranger> take_early(std::span<std::byte> buffer) noexcept;

  /// io, before rt gets the socket: the address that the peer had until now.
  void follow(const Endpoint& former) noexcept { detour_ = Detour{former}; }

  [[nodiscard]] Endpoint local() const noexcept;
  [[nodiscard]] Endpoint peer() const noexcept { return peer_; }

 private:
  struct Batch;

  UdpSocket(Descriptor socket, const Endpoint& peer, SideInbox& inbox);
  bool fetch() noexcept;
  std::optional<link::Datagram> take_detour(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                            TimePoint now) noexcept;
  void begin_tick(TimePoint now) noexcept;

  Descriptor socket_;
  Endpoint peer_;
  SideInbox& inbox_;
  std::unique_ptr<Batch> batch_;
  Detour detour_;
  bool straight_{};  ///< what receive() gave last came from the peer's address
  TimePoint tick_{TimePoint::min()};
  std::size_t taken_{};  ///< in this tick
  int errors_{};         ///< in this tick
  bool drained_{};       ///< the kernel had no more in this tick
};

/// Marks of every data datagram of ours (WIRE.md): version 8, type 0.
inline constexpr std::byte kDataFirstByte{0x80};

}  // namespace palp::io
