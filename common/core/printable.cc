#include "common/core/printable.h"

#include <cstddef>

namespace palp {
namespace {

constexpr std::size_t kPrintableMax = 80;

/// The first character of `text`, which is not empty, and how many bytes it takes; 0xfffd and 1
/// where they are no UTF-8.
struct Character {
  char32_t code{0xfffd};
  std::size_t size{1};
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t size = lead >= 0xf0 ? 4 : (lead >= 0xe0 ? 3 : 2);
  if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return {};
  char32_t code = lead & (0x7fU >> size);
  for (std::size_t at = 1; at < size; ++at) {
    if ((byte(at) & 0xc0U) != 0x80) return {};
    code = (code << 6U) | (byte(at) & 0x3fU);
  }
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeast[size] || code > 0x10ffff || surrogate) return {};
  return {code, size};
}

/// Obeyed by terminals, or turning the order of what stands beside it.
bool acts(char32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0xfffd ||
         (code >= 0x200e && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069);
}

std::string without_acting(std::string_view text, std::string_view kept) {
  std::string clean;
  while (!text.empty()) {
    const Character first = first_character(text);
    const bool keeps = !acts(first.code) || kept.find(text[0]) != std::string_view::npos;
    keeps ? clean.append(text.substr(0, first.size)) : clean.append("?");
    text.remove_prefix(first.size);
  }
  return clean;
}

}  // namespace

std::string harmless(std::string_view text) { return without_acting(text, "\t\n"); }
std::string harmless_line(std::string_view text) { return without_acting(text, ""); }

std::string printable(std::string_view text) {
  std::string clean;
  for (const char c : text.substr(0, kPrintableMax)) {
    clean += c >= ' ' && c <= '~' ? c : '?';
  }
  return text.size() > kPrintableMax ? clean + "..." : clean;
}

}  // namespace palp
