#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "common/link/packet_protection.h"
#include "common/link/transport.h"

namespace palp::lab {

/// What an attacker, or a broken box on the path, may put between the datagrams of the peer.
enum class Forgery : std::uint8_t {
  Noise,            ///< random bytes of any size
  CutOff,           ///< the first half of the newest datagram
  Garbage,          ///< a header that the peer will use soon, followed by random bytes
  WrongConnection,  ///< the newest datagram under another connection id
  Repeated,         ///< the newest datagram again
  Ancient,          ///< one from before the replay window
  Control,          ///< the newest datagram as another type
  TooLong           ///< more than a buffer holds
};
inline constexpr std::uint8_t kForgeryCount = 8;

/// An end of a path that mixes forgeries into what arrives: one in most ticks, and every second so
/// many in one tick that a link's budget for a tick is spent on them. Fit for rt, as a Transport
/// must be. Owns the true end. Thread: its Link's.
class HostileEnd final : public link::Transport {
 public:
  HostileEnd(std::unique_ptr<link::Transport> end, std::uint64_t seed);
  ~HostileEnd() override;

  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override;
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override;

 private:
  struct Memory;  ///< of what arrived lately

  [[nodiscard]] std::uint64_t draw() noexcept;
  void plan(TimePoint now) noexcept;
  /// @returns the size, 0: nothing to forge from yet.
  [[nodiscard]] std::size_t forge(Forgery forgery, std::span<std::byte> buffer) noexcept;
  void fill(std::span<std::byte> bytes) noexcept;

  std::unique_ptr<link::Transport> end_;
  std::unique_ptr<Memory> memory_;
  std::uint64_t seed_;
  std::uint64_t draws_{};
  std::uint64_t ticks_{};
  TimePoint planned_for_{};
  std::size_t waiting_{};  ///< forgeries still to be given in this tick
};

/// PlainProtection with a tag that has no secret: enough for a link to tell garbage from what its
/// peer sent, so that the way of a datagram with a wrong tag is walked too. Thread: its Link's.
class TaggedProtection final : public link::PacketProtection {
 public:
  [[nodiscard]] std::size_t overhead() const noexcept override { return kTagSize; }
  std::size_t seal(const link::Header& header,
                   std::span<const std::byte> plain,
                   std::span<std::byte> out) noexcept override;
  tl::expected<link::Header, link::Rejection> read_header(
      std::span<const std::byte> datagram) noexcept override {
    return plain_.read_header(datagram);
  }
  tl::expected<std::size_t, link::Rejection> open(const link::Header& header,
                                                  std::span<const std::byte> datagram,
                                                  std::span<std::byte> plain) noexcept override;

 private:
  static constexpr std::size_t kTagSize = 8;  ///< [bytes]

  link::PlainProtection plain_;
  std::array<std::byte, link::kDatagramSizeMax> work_{};
};

}  // namespace palp::lab
