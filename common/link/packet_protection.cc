#include "common/link/packet_protection.h"

#include <algorithm>
#include <limits>

namespace palp::link {

std::size_t PlainProtection::seal(const Header& header,
                                  std::span<const std::byte> plain,
                                  std::span<std::byte> out) noexcept {
  if (plain.size() > std::numeric_limits<std::uint16_t>::max()) return 0;
  if (out.size() < kHeaderSize + plain.size()) return 0;
  Header complete = header;
  complete.length = static_cast<std::uint16_t>(plain.size());
  pack_header(complete, out.first<kHeaderSize>());
  std::copy(plain.begin(), plain.end(), out.begin() + kHeaderSize);
  return kHeaderSize + plain.size();
}

tl::expected<Header, Rejection> PlainProtection::read_header(
    std::span<const std::byte> datagram) noexcept {
  const std::optional<Header> header = parse_header(datagram);
  if (!header) return tl::unexpected(Rejection::Malformed);
  if (header->key != 0) return tl::unexpected(Rejection::Foreign);
  return *header;
}

tl::expected<std::size_t, Rejection> PlainProtection::open(const Header& /*header*/,
                                                           std::span<const std::byte> datagram,
                                                           std::span<std::byte> plain) noexcept {
  const std::span<const std::byte> payload = datagram.subspan(kHeaderSize);
  if (payload.size() > plain.size()) return tl::unexpected(Rejection::Malformed);
  std::copy(payload.begin(), payload.end(), plain.begin());
  return payload.size();
}

}  // namespace palp::link
