#include "common/message/wire_format.h"

namespace palp::message {
namespace {

constexpr unsigned kGroupBegin = 3;
constexpr unsigned kGroupEnd = 4;
constexpr std::size_t kTagSizeMax = 5;  ///< [bytes]
constexpr std::size_t kGroupDepthMax = 100;

}  // namespace

bool WireReader::skip_field() noexcept {
  std::array<std::uint64_t, kGroupDepthMax> groups{};  // those that are open, outermost first
  std::size_t depth = 0;
  do {
    std::uint64_t tag = 0;
    std::uint64_t varint = 0;
    std::span<const std::byte> part;
    const std::size_t before = bytes_.size();
    if (!take_varint(tag, kTagSizeMax) || tag > UINT32_MAX || tag >> 3U == 0) return false;
    // In more bytes than it needs it may be the tag of a field that is known.
    const bool longer = before - bytes_.size() > 1 && *(bytes_.data() - 1) == std::byte{0};
    if (longer) return false;
    switch (tag & 7U) {
      case static_cast<unsigned>(WireType::Varint):
        if (!take_varint(varint)) return false;
        break;
      case static_cast<unsigned>(WireType::Fixed64):
        if (!take_fixed(varint)) return false;
        break;
      case static_cast<unsigned>(WireType::Part):
        if (!take_bytes(part)) return false;
        break;
      case static_cast<unsigned>(WireType::Fixed32): {
        std::uint32_t fixed = 0;
        if (!take_fixed(fixed)) return false;
        break;
      }
      case kGroupBegin:
        if (depth == groups.size()) return false;
        groups[depth++] = tag >> 3U;
        break;
      case kGroupEnd:
        if (depth == 0 || groups[--depth] != tag >> 3U) return false;
        break;
      default:
        return false;
    }
  } while (depth > 0);
  return true;
}

}  // namespace palp::message
