#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/link/telegram.h"

namespace palp::link {

/// Bytes that are wiped when they go. A value; copies are wiped too.
template <std::size_t kSize>
class Secret {
 public:
  Secret() noexcept = default;
  explicit Secret(std::span<const std::byte, kSize> bytes) noexcept {
    for (std::size_t i = 0; i < kSize; ++i) bytes_[i] = bytes[i];
  }
  Secret(const Secret&) noexcept = default;
  Secret& operator=(const Secret&) noexcept = default;
  ~Secret() {
    // Volatile, or the compiler leaves out what nobody reads any more.
    for (std::byte& byte : bytes_) *static_cast<volatile std::byte*>(&byte) = std::byte{};
  }
  [[nodiscard]] std::span<const std::byte, kSize> bytes() const noexcept { return bytes_; }
  bool operator==(const Secret& other) const noexcept = default;

 private:
  std::array<std::byte, kSize> bytes_{};
};

/// Of AES-256-GCM and of the mask over its headers, one direction.
struct AeadKey {
  static constexpr std::size_t kKeySize = 32;   ///< [bytes]
  static constexpr std::size_t kSaltSize = 12;  ///< [bytes], as long as a nonce

  Secret<kKeySize> key;
  Secret<kSaltSize> salt;
  Secret<kKeySize> header_key;  ///< of AES-256: hides connection id and number
};

/// Both directions of a plane, as one end uses them. A number must be sealed once at most under
/// `send`: whoever holds these keys has one counter for them.
struct TrafficKeys {
  std::uint8_t id{};  ///< in the header, 0..3
  AeadKey send;
  AeadKey receive;
};

/// A plane of its own, with a connection id for each direction.
struct PlaneKeys {
  /// [bytes] to be exported: two directions, two ids.
  static constexpr std::size_t kExportedSize =
      2 * (2 * AeadKey::kKeySize + AeadKey::kSaltSize) + 2 * sizeof(std::uint32_t);

  TrafficKeys keys;
  std::uint32_t send_connection{};     ///< never 0
  std::uint32_t receive_connection{};  ///< never 0

  /// As SessionKeys.
  [[nodiscard]] static PlaneKeys from_exported(std::span<const std::byte, kExportedSize> bytes,
                                               Role role) noexcept;
};

/// What a handshake leaves behind for force and for control: keys for the two planes, one counted
/// by rt, the other by io, and a connection id for each direction of the control plane.
struct SessionKeys {
  /// [bytes] to be exported from a handshake: two planes, two directions, two ids.
  static constexpr std::size_t kExportedSize =
      4 * (2 * AeadKey::kKeySize + AeadKey::kSaltSize) + 2 * sizeof(std::uint32_t);

  TrafficKeys data;
  TrafficKeys control;
  std::uint32_t send_connection{};     ///< of control datagrams we send; never 0
  std::uint32_t receive_connection{};  ///< of those we receive; never 0

  /// The same bytes at both ends; each takes its own side of them.
  [[nodiscard]] static SessionKeys from_exported(std::span<const std::byte, kExportedSize> bytes,
                                                 Role role) noexcept;
};

}  // namespace palp::link
