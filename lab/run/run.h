#pragma once

#include <cstdint>
#include <vector>

#include "common/link/telegram.h"
#include "common/message/depth.h"
#include "common/record/byte_sink.h"
#include "lab/run/metrics.h"
#include "lab/run/scenario.h"
#include "surgeon_site/haptic_device.h"

namespace palp::lab {

/// What came out of one run in virtual time.
struct RunResult {
  std::uint64_t digest{};  ///< over every state and output of both nodes at every tick
  TimePoint began_at{};
  Duration virtual_span{};
  surgeon::ScriptOutcome outcome{};
  RunMetrics metrics;
  std::vector<RunTick> ticks;         ///< while the script was performed
  std::vector<DepthEstimate> depths;  ///< one per stroke, in order
  LinkHealth surgeon_link;
  LinkHealth patient_link;
  std::uint64_t records{};  ///< written to both session files
};

/// Where the session files go; null: encoded and compressed all the same, then thrown away.
struct RunFiles {
  record::ByteSink* surgeon{};
  record::ByteSink* patient{};
};

/// Runs the scenario on the caller's thread. Deterministic.
[[nodiscard]] RunResult simulate(const Scenario& scenario, const RunFiles& files = {});

}  // namespace palp::lab
