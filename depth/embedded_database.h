#pragma once

#include <string_view>

namespace palp::depth {

/// The bytes of fem/depth_database.bin, which the build puts into the library, so that a program
/// needs no folder beside it.
[[nodiscard]] std::string_view embedded_database() noexcept;

}  // namespace palp::depth
