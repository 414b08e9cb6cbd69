#include "common/plot/style.h"

namespace palp::plot {

std::optional<Style> style_of(std::string_view name) noexcept {
  for (const Style& style : kStyles) {
    if (style.name == name) return style;
  }
  return std::nullopt;
}

}  // namespace palp::plot
