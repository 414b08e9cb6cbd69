#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// Numbers as people type and read them. Strict on purpose: the whole text must be the number, in
/// the C locale, without blanks, sign "+", hexadecimal, nan or inf.
namespace palp::config {

[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;

/// As parse_number(); also "5%" for 0.05.
[[nodiscard]] std::optional<double> parse_share(std::string_view text) noexcept;

/// Digits only.
[[nodiscard]] std::optional<std::uint64_t> parse_whole(std::string_view text) noexcept;
/// Digits, and "-" before them.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text) noexcept;

/// The shortest text that reads back as the same double; "nan" and "inf" for what is not finite.
[[nodiscard]] std::string number_text(double value);

/// "0.1 to 10 N"; the unit "1" or "" is left out; "share": "0 to 1 (0% to 100%)".
[[nodiscard]] std::string range_text(double min, double max, std::string_view unit);

}  // namespace palp::config
