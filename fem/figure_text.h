#pragma once

#include <string>

#include "common/core/conventions.h"
#include "common/core/formatted.h"

/// Numbers as the sentences of this room write them. Thread: any; allocate.
namespace palp::fem {

[[nodiscard]] inline std::string figure_text(double value) { return formatted("%.6g", value); }
/// `length` [m] as "12.5 mm".
[[nodiscard]] inline std::string length_text(double length) {
  return formatted("%.6g mm", length / kMillimetre);
}

}  // namespace palp::fem
