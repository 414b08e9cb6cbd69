#include "common/message/text_encoding.h"

#include <cstdint>

namespace palp::message {
namespace {

/// How a character of two bytes or more begins, and what its code may be.
struct Shape {
  unsigned lead_mask{};
  unsigned lead{};
  std::size_t following{};  ///< [bytes]
  std::uint32_t least{};
  std::uint32_t most{};
};
constexpr Shape kShapes[]{{0xE0, 0xC0, 1, 0x80, 0x7FF},
                          {0xF0, 0xE0, 2, 0x800, 0xFFFF},
                          {0xF8, 0xF0, 3, 0x10000, 0x10FFFF}};

/// @returns bytes of the character that begins `text`, 0: there is none.
std::size_t character_size(std::string_view text) noexcept {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return 1;
  for (const Shape& shape : kShapes) {
    if ((first & shape.lead_mask) != shape.lead) continue;
    if (text.size() <= shape.following) return 0;
    std::uint32_t code = first & ~shape.lead_mask & 0xFFU;
    for (std::size_t i = 1; i <= shape.following; ++i) {
      const auto byte = static_cast<unsigned char>(text[i]);
      if ((byte & 0xC0U) != 0x80) return 0;
      code = code << 6U | (byte & 0x3FU);
    }
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return code >= shape.least && code <= shape.most && !surrogate ? 1 + shape.following : 0;
  }
  return 0;
}

}  // namespace

bool is_utf8(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t size = character_size(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

}  // namespace palp::message
