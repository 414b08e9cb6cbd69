#pragma once

#include <cstdint>
#include <string>

#include "common/core/result.h"
#include "netem/relay.h"

namespace palp::netem {

/// What the report says beside the relay's own numbers.
struct RelayRun {
  std::string preset;  ///< empty: none
  Impairment up;
  Impairment down;
  std::uint64_t seed{};
  Endpoint forward;
  Duration duration{};
};

/// JSON, schema "palp.relay/1".
[[nodiscard]] std::string relay_report(const Relay& relay, const RelayRun& run);

/// Two lines for people.
[[nodiscard]] std::string relay_summary(const Relay& relay);

/// Writes a file whole: under a temporary name first, then renamed.
/// @returns or the sentence that says why not.
[[nodiscard]] Result<std::string> write_whole(const std::string& path, const std::string& text);

}  // namespace palp::netem
