#pragma once

#include <cstdint>
#include <string>

#include "netem/relay.h"

namespace palp::netem {

/// What the report says beside the relay's own numbers.
struct RelayRun {
  std::string preset;  ///< empty: none
  Impairment up;
  Impairment down;
  std::uint64_t seed{};
  io::Endpoint forward;
  Duration duration{};
};

/// JSON, schema "palp.relay/1".
[[nodiscard]] std::string relay_report(const Relay& relay, const RelayRun& run);

/// Two lines for people.
[[nodiscard]] std::string relay_summary(const Relay& relay);

}  // namespace palp::netem
