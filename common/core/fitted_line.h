#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palp {

/// A part of a line for people, and what may stand for it where the line is too narrow.
struct LinePart {
  std::string full;
  std::string brief;  ///< may be empty: then the part goes
  int rank{};         ///< [-] the lowest is shortened first
};

/// The parts that are not empty, in their order, two spaces between them; one after the other made
/// brief until the line fits. It may still be too long when all are. `columns`: 0 for any length.
[[nodiscard]] std::string fitted_line(std::span<LinePart> parts, std::size_t columns);

}  // namespace palp
