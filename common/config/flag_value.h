#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/host_and_port.h"
#include "common/core/result.h"

/// What the value of a flag may be, and its reading. The sentences name flag, value and limit.
namespace palp::config {

/// Inclusive range of a flag and its unit ("1": none).
struct NumberRange {
  double min{};  ///< [unit]
  double max{};  ///< [unit]
  std::string unit{"1"};
};
struct WholeRange {
  std::uint64_t min{};
  std::uint64_t max{};
  std::string unit{"1"};
};

/// Finite, and in the range.
[[nodiscard]] Result<double> read_number(const std::string& flag,
                                         const std::string& text,
                                         const NumberRange& range);

[[nodiscard]] Result<std::uint64_t> read_whole(const std::string& flag,
                                               const std::string& text,
                                               const WholeRange& range);

/// One of `choices`, letter by letter.
[[nodiscard]] Result<std::string> read_choice(const std::string& flag,
                                              const std::string& text,
                                              const std::vector<std::string>& choices);

/// Not empty.
[[nodiscard]] Result<std::string> read_text(const std::string& flag, const std::string& text);

/// HOST:PORT.
[[nodiscard]] Result<HostAndPort> read_address(const std::string& flag,
                                               const std::string& text,
                                               std::uint16_t port_min);

/// Of a switch, which takes no value: "true" is what the parser puts there.
[[nodiscard]] Result<void> read_switch(const std::string& flag, const std::string& text);

/// "MEANING [N], 0 to 3": what --help says.
[[nodiscard]] std::string describe(const std::string& meaning, const NumberRange& range);
[[nodiscard]] std::string describe(const std::string& meaning, const WholeRange& range);

/// "a, b, c"
[[nodiscard]] std::string list_text(const std::vector<std::string>& names);

}  // namespace palp::config
