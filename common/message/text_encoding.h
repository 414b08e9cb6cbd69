#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace palp::message {

/// Valid as long as the bytes.
[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes of a text
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// True for what a `string` of protobuf may hold: UTF-8 in its shortest form, without surrogates.
[[nodiscard]] bool is_utf8(std::string_view text) noexcept;

}  // namespace palp::message
