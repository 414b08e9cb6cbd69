#include "common/config/number.h"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace palp::config {
namespace {

template <class Number>
std::optional<Number> parse(std::string_view text) noexcept {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stopped_at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped_at != end) {
    return std::nullopt;
  }
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) noexcept {
  const auto value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> parse_share(std::string_view text) noexcept {
  if (!text.ends_with('%')) {
    return parse_number(text);
  }
  const auto percent = parse_number(text.substr(0, text.size() - 1));
  return percent ? std::optional{*percent / 100} : std::nullopt;
}

std::optional<std::uint64_t> parse_whole(std::string_view text) noexcept {
  return parse<std::uint64_t>(text);
}

std::optional<std::int64_t> parse_integer(std::string_view text) noexcept {
  return parse<std::int64_t>(text);
}

std::string number_text(double value) {
  std::array<char, 32> buffer{};  // the longest double is -2.2250738585072014e-308: 24 characters
  const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), written.ptr};
}

std::string range_text(double min, double max, std::string_view unit) {
  std::string text = number_text(min) + " to " + number_text(max);
  if (unit == "share") {
    text += " (" + number_text(100 * min) + "% to " + number_text(100 * max) + "%)";
  } else if (!unit.empty() && unit != "1") {
    text.append(" ").append(unit);
  }
  return text;
}

}  // namespace palp::config
