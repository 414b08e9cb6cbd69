#include "common/config/flag_value.h"

#include <algorithm>

#include "common/config/number.h"
#include "common/core/printable.h"

namespace palp::config {
namespace {

std::string describe(const std::string& meaning,
                     const std::string& unit,
                     const std::string& range) {
  return meaning + (unit == "1" ? "" : " [" + unit + ']') + ", " + range;
}

std::string range_of(const WholeRange& range) {
  return std::to_string(range.min) + " to " + std::to_string(range.max);
}

}  // namespace

Result<double> read_number(const std::string& flag,
                           const std::string& text,
                           const NumberRange& range) {
  const auto number = parse_number(text);
  const std::string limits = range_text(range.min, range.max, range.unit);
  if (!number) {
    return fail(flag + " = " + printable(text) + " is not a number: " + limits);
  }
  if (*number < range.min || *number > range.max) {
    return fail(flag + " = " + printable(text) + " is out of range: " + limits);
  }
  return *number;
}

Result<std::uint64_t> read_whole(const std::string& flag,
                                 const std::string& text,
                                 const WholeRange& range) {
  const auto number = parse_whole(text);
  if (number && *number >= range.min && *number <= range.max) {
    return *number;
  }
  return fail(flag + " = " + printable(text) +
              (number ? " is out of range: " : " is not a whole number: ") +
              std::to_string(range.min) + " to " + std::to_string(range.max) +
              (range.unit == "1" ? "" : ' ' + range.unit));
}

Result<std::string> read_choice(const std::string& flag,
                                const std::string& text,
                                const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
    return fail(flag + " = " + printable(text) + " is not one of: " + list_text(choices));
  }
  return text;
}

Result<std::string> read_text(const std::string& flag, const std::string& text) {
  if (text.empty() || text.find('\0') != std::string::npos) return fail(flag + " is empty");
  return text;
}

Result<HostAndPort> read_address(const std::string& flag,
                                 const std::string& text,
                                 std::uint16_t port_min) {
  return parse_host_and_port(text, port_min).map_error([&flag](const Error& error) {
    return Error{flag + ": " + error.text};
  });
}

Result<void> read_switch(const std::string& flag, const std::string& text) {
  return text == "true" ? Result<void>{} : fail(flag + " takes no value");
}

std::string describe(const std::string& meaning, const NumberRange& range) {
  return describe(meaning, range.unit, range_text(range.min, range.max, ""));
}

std::string describe(const std::string& meaning, const WholeRange& range) {
  return describe(meaning, range.unit, range_of(range));
}

std::string list_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

}  // namespace palp::config
