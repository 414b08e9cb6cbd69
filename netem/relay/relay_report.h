#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "netem/relay/relay.h"

namespace palp::netem {

/// What the report says beside the relay's own numbers.
struct RelayRun {
  std::string preset;  ///< empty: none
  std::string up;      ///< the words in force at the start
  std::string down;
  std::uint64_t seed{};
  io::Endpoint forward;
  Duration duration{};
};

/// JSON, schema "palp.relay/1".
[[nodiscard]] std::string relay_report(const Relay& relay, const RelayRun& run);

/// Two lines for people.
[[nodiscard]] std::string relay_summary(const Relay& relay);

/// One line for people while it runs, and the same as one line of JSON.
[[nodiscard]] std::string status_line(const RelayStatus& status, TimePoint start);
/// `laws`: the words that hold now, by Direction.
[[nodiscard]] std::string status_json(const RelayStatus& status,
                                      TimePoint start,
                                      const std::array<std::string, 2>& laws);

/// {"recording": false, ...} with what it lacks.
[[nodiscard]] std::string recording_end_line(const RecordingGaps& gaps);

/// {"error": "..."}
[[nodiscard]] std::string error_line(const std::string& sentence);

}  // namespace palp::netem
