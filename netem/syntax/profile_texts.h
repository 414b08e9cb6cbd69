#pragma once

#include <span>
#include <string_view>

namespace palp::netem {

struct ProfileText {
  std::string_view name;
  std::string_view text;
};

/// The files of profiles/, built into the program by CMake so that it runs from anywhere.
[[nodiscard]] std::span<const ProfileText> profile_texts() noexcept;

}  // namespace palp::netem
