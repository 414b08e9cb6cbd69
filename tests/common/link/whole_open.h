#pragma once

#include <cstddef>
#include <span>

#include "common/link/packet_protection.h"

namespace palp::link {

/// What a receiver does with a datagram whose connection id and number it does not look at.
inline tl::expected<std::size_t, Rejection> whole_open(PacketProtection& protection,
                                                       std::span<const std::byte> datagram,
                                                       std::span<std::byte> plain) {
  const auto header = protection.read_header(datagram);
  if (!header) return tl::unexpected(header.error());
  return protection.open(*header, datagram, plain);
}

}  // namespace palp::link
