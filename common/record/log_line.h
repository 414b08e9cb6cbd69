#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/link/telegram.h"
#include "common/message/record.h"
#include "common/record/mcap_format.h"

/// Events once more as `foxglove.Log`, which plot programs know: they list it with time and colour.
/// Derived, as views are; nobody of ours reads it. Thread: any.
namespace palp::record {

/// As foxglove.Log numbers them.
enum class LogLevel : std::uint8_t { Info = 2, Warning = 3, Error = 4 };

struct LogLine {
  LogLevel level{};
  std::string_view site;  ///< "surgeon"
  std::string text;       ///< "ENGAGED -> HOLD: nothing arrived: hold"
};

/// nullopt: the record is no event.
[[nodiscard]] std::optional<LogLine> log_line_of(const Record& record, link::Role site);

inline constexpr std::string_view kLogLineSchema{"foxglove.Log"};
/// FileDescriptorSet of that message and of google.protobuf.Timestamp.
[[nodiscard]] Bytes log_line_descriptors();
/// `stamp`: [ns] since 1970.
[[nodiscard]] Bytes log_line_bytes(const LogLine& line, std::uint64_t stamp);

}  // namespace palp::record
