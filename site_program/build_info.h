#pragma once

#include <string_view>

namespace palp::site_program {

[[nodiscard]] std::string_view version() noexcept;
/// Short; "unknown" where the source was no git repository.
[[nodiscard]] std::string_view git_commit() noexcept;
/// Name and version.
[[nodiscard]] std::string_view compiler() noexcept;

}  // namespace palp::site_program
