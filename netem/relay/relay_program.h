#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "netem/model/path_plan.h"
#include "netem/relay/relay_control.h"
#include "netem/syntax/timeline.h"

namespace palp::netem {

/// What `palp-netem relay` is told, read and checked.
struct RelayProgramConfig {
  io::Endpoint listen;
  io::Endpoint forward;
  std::string preset;  ///< or the name of the timeline's file; empty: neither
  PathPlan up{};
  PathPlan down{};
  std::uint64_t seed{1};
  std::string record;          ///< prefix; empty: none
  std::string control;         ///< address; empty: none
  std::string control_token;   ///< what a caller by TCP says first
  std::string control_folder;  ///< whose files the control may name; empty: none
  std::string report;          ///< empty: none
  Duration duration{};
  Duration status_every{};  ///< 0: no line
  int stop_descriptor{-1};
};

/// Serves until told to stop: the relay on the calling thread, everything that may wait (control,
/// recording, the status line) on a thread of ordinary priority.
/// @returns or why it could not begin, or write what it should. @throws std::system_error.
[[nodiscard]] Result<void> run_relay(const RelayProgramConfig& config);

}  // namespace palp::netem
