#pragma once

#include <string>

#include "common/core/result.h"

namespace palp::plot {

/// The same picture as PDF, by rsvg-convert. Blocks. Fails with a sentence where that program is
/// missing, or refuses the picture.
[[nodiscard]] Result<std::string> pdf_of(const std::string& svg);

}  // namespace palp::plot
