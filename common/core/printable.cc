#include "common/core/printable.h"

#include <cstddef>

namespace palp {
namespace {

constexpr std::size_t kPrintableMax = 80;

}  // namespace

std::string printable(std::string_view text) {
  std::string clean;
  for (const char c : text.substr(0, kPrintableMax)) {
    clean += c >= ' ' && c <= '~' ? c : '?';
  }
  return text.size() > kPrintableMax ? clean + "..." : clean;
}

}  // namespace palp
