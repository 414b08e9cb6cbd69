#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::io {

/// Marks addresses without remembering any: who shows a cookie has received it at the address that
/// it was made for. Good for ten seconds. The secret lasts as long as this object, so no cookie
/// outlives the program. A value but for that. Thread: its owner's.
class AddressCookie {
 public:
  using Bytes = std::array<std::byte, 24>;
  static constexpr Duration kLife = std::chrono::seconds{10};

  /// @throws std::runtime_error where the system has no randomness.
  AddressCookie();

  /// `bound_to`: what else the cookie is for.
  [[nodiscard]] Bytes make(const Endpoint& from,
                           std::span<const std::byte> bound_to,
                           TimePoint now) const noexcept;
  /// When it was made; nullopt: not by us, for another address or another purpose, or too long ago.
  [[nodiscard]] std::optional<TimePoint> made_at(const Bytes& cookie,
                                                 const Endpoint& from,
                                                 std::span<const std::byte> bound_to,
                                                 TimePoint now) const noexcept;

 private:
  [[nodiscard]] Bytes sealed(std::uint64_t time,
                             const Endpoint& from,
                             std::span<const std::byte> bound_to) const noexcept;

  std::array<unsigned char, 32> secret_{};
};

}  // namespace palp::io
