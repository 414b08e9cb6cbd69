#include "netem/relay/pcapng.h"

#include <cstring>

namespace palp::netem {
namespace {

constexpr std::uint32_t kSectionHeader = 0x0a0d0d0a;
constexpr std::uint32_t kInterface = 1;
constexpr std::uint32_t kEnhancedPacket = 6;
constexpr std::uint16_t kLinkTypeRaw = 101;
constexpr std::uint16_t kUdp = 17;

template <class Number>
void put(std::string& file, Number number) {
  char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  file.append(bytes, sizeof number);
}

void pad(std::string& file) { file.append((4 - file.size() % 4) % 4, '\0'); }

void put_option(std::string& file, std::uint16_t code, std::string_view value) {
  put(file, code);
  put(file, static_cast<std::uint16_t>(value.size()));
  file.append(value);
  pad(file);
}

void put_block(std::string& file, std::uint32_t type, std::string_view body) {
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  put(file, type);
  put(file, length);
  file.append(body);
  put(file, length);
}

void put_network(std::string& packet, std::uint16_t number) {
  packet += static_cast<char>(number >> 8U);
  packet += static_cast<char>(number & 0xffU);
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// RFC 1071.
std::uint16_t checksum(std::string_view bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::uint32_t byte = static_cast<unsigned char>(bytes[i]);
    sum += i % 2 == 0 ? byte << 8U : byte;
  }
  while (sum >> 16U) sum = (sum & 0xffffU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

std::string ip_packet(const DatagramAddresses& addresses,
                      std::uint8_t tos,
                      std::span<const std::byte> payload) {
  constexpr std::size_t kUdpHeader = 8;
  const auto udp = static_cast<std::uint16_t>(kUdpHeader + payload.size());
  std::string packet;
  if (addresses.from.size() == 4) {
    packet = {0x45, static_cast<char>(tos)};
    put_network(packet, static_cast<std::uint16_t>(20 + udp));
    packet.append({0, 0, 0x40, 0, 64, kUdp, 0, 0});
    packet.append(as_text(addresses.from)).append(as_text(addresses.to));
    const std::uint16_t sum = checksum(packet);
    packet[10] = static_cast<char>(sum >> 8U);
    packet[11] = static_cast<char>(sum & 0xffU);
  } else {
    packet = {static_cast<char>(0x60U | (tos >> 4U)), static_cast<char>(tos << 4U), 0, 0};
    put_network(packet, udp);
    packet.append({kUdp, 64});
    packet.append(as_text(addresses.from)).append(as_text(addresses.to));
  }
  put_network(packet, addresses.from_port);
  put_network(packet, addresses.to_port);
  put_network(packet, udp);
  put_network(packet, 0);  // no checksum: the payload may be flipped on purpose
  return packet.append(as_text(payload));
}

}  // namespace

void append_section_header(std::string& file) {
  std::string body;
  put(body, std::uint32_t{0x1a2b3c4d});
  put(body, std::uint16_t{1});
  put(body, std::uint16_t{0});
  put(body, std::int64_t{-1});
  put_option(body, 4, "palp-netem");
  put(body, std::uint32_t{0});
  put_block(file, kSectionHeader, body);
}

void append_interface(std::string& file, std::string_view name) {
  std::string body;
  put(body, kLinkTypeRaw);
  put(body, std::uint16_t{0});
  put(body, std::uint32_t{0});  // whole packets
  put_option(body, 2, name);
  put_option(body, 9, "\x09");  // times in nanoseconds
  put(body, std::uint32_t{0});
  put_block(file, kInterface, body);
}

void append_datagram(std::string& file,
                     std::uint32_t interface,
                     Duration since_1970,
                     bool outbound,
                     const DatagramAddresses& addresses,
                     std::uint8_t tos,
                     std::span<const std::byte> payload) {
  const std::string packet = ip_packet(addresses, tos, payload);
  const auto time = static_cast<std::uint64_t>(since_1970.count());
  std::string body;
  put(body, interface);
  put(body, static_cast<std::uint32_t>(time >> 32U));
  put(body, static_cast<std::uint32_t>(time));
  put(body, static_cast<std::uint32_t>(packet.size()));
  put(body, static_cast<std::uint32_t>(packet.size()));
  body.append(packet);
  pad(body);
  const std::uint32_t flags = outbound ? 2 : 1;
  put(body, std::uint16_t{2});
  put(body, std::uint16_t{4});
  put(body, flags);
  put(body, std::uint32_t{0});
  put_block(file, kEnhancedPacket, body);
}

}  // namespace palp::netem
