#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/result.h"
#include "common/link/header.h"

namespace palp::link {

/// Why a datagram was refused before its content counted.
enum class Rejection : std::uint8_t {
  Malformed,  ///< breaks a rule of form
  Foreign,    ///< not of this connection, plane or key
  Replayed,   ///< its number was seen already
  TooOld,     ///< its number is behind the replay window
  Forged,     ///< its tag does not fit
};

/// Turns a header and plain bytes into a datagram and back. An object that encrypts prepares its
/// contexts in the constructor, off the rt thread. Thread: one per object, its Link's.
class PacketProtection {
 public:
  virtual ~PacketProtection() = default;
  /// Bytes added behind the payload; at most 16 (the tag).
  [[nodiscard]] virtual std::size_t overhead() const noexcept = 0;
  /// Writes header, payload and tag; sets the header's length and key id itself. Each number at
  /// most once.
  /// @returns bytes written, 0 where `out` is too small.
  virtual std::size_t seal(const Header& header,
                           std::span<const std::byte> plain,
                           std::span<std::byte> out) noexcept = 0;
  /// What the header says; nothing of it is proven. Where it is hidden and not for us, connection
  /// and number are anything.
  virtual tl::expected<Header, Rejection> read_header(
      std::span<const std::byte> datagram) noexcept = 0;
  /// Writes the payload and changes no state: a refused datagram leaves no trace here. `header` is
  /// what read_header() said of this datagram.
  /// @returns bytes written into `plain`.
  virtual tl::expected<std::size_t, Rejection> open(const Header& header,
                                                    std::span<const std::byte> datagram,
                                                    std::span<std::byte> plain) noexcept = 0;
  /// Seals `plain` and opens it again under keys that protect nothing, in `room`: only so that code
  /// and tables are in the processor's caches when they are needed. Changes nothing that counts.
  virtual void warm_up(std::span<const std::byte> /*plain*/,
                       std::span<std::byte> /*room*/) noexcept {}
};

/// Header and payload, nothing else: anybody on the path can read, change and forge.
/// For virtual time, and for links that something else protects. Thread: any.
class PlainProtection final : public PacketProtection {
 public:
  [[nodiscard]] std::size_t overhead() const noexcept override { return 0; }
  std::size_t seal(const Header& header,
                   std::span<const std::byte> plain,
                   std::span<std::byte> out) noexcept override;
  tl::expected<Header, Rejection> read_header(
      std::span<const std::byte> datagram) noexcept override;
  tl::expected<std::size_t, Rejection> open(const Header& header,
                                            std::span<const std::byte> datagram,
                                            std::span<std::byte> plain) noexcept override;
};

}  // namespace palp::link
