#pragma once

#include <array>
#include <cstdint>

#include "common/core/random.h"
#include "common/link/traffic_keys.h"

namespace palp::link {

/// What a handshake with this number would leave at one end.
inline SessionKeys some_keys(std::uint64_t handshake, Role role, std::uint8_t id = 0) {
  std::array<std::byte, SessionKeys::kExportedSize> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::byte>(random_bits(handshake, 77, i));
  }
  SessionKeys keys = SessionKeys::from_exported(bytes, role);
  keys.data.id = id;
  return keys;
}

}  // namespace palp::link
