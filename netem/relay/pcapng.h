#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "common/core/time.h"

/// Blocks of the capture format pcapng (IETF draft-ietf-opsawg-pcapng), appended to a text, in this
/// machine's byte order. Packets are of link type RAW: they begin with the IP header.
namespace palp::netem {

void append_section_header(std::string& file);
void append_interface(std::string& file, std::string_view name);

/// The two ends of a datagram, as bytes in network order: 4 or 16, both alike.
struct DatagramAddresses {
  std::span<const std::byte> from;
  std::span<const std::byte> to;
  std::uint16_t from_port{};
  std::uint16_t to_port{};
};

/// A UDP datagram with headers made for it. `since_1970`; `outbound`: the owner of the interface
/// sent it.
void append_datagram(std::string& file,
                     std::uint32_t interface,
                     Duration since_1970,
                     bool outbound,
                     const DatagramAddresses& addresses,
                     std::uint8_t tos,
                     std::span<const std::byte> payload);

}  // namespace palp::netem
