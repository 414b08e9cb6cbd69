#pragma once

#include <cstdint>
#include <vector>

#include "common/link/telegram.h"
#include "common/message/depth.h"
#include "common/message/map_report.h"
#include "judge/metrics.h"
#include "judge/stroke_pairing.h"
#include "lab/run/scenario.h"
#include "lab/run/session_files.h"
#include "surgeon_site/haptic_device.h"

namespace palp::lab {

/// What came out of one run in virtual time.
struct RunResult {
  std::uint64_t digest{};  ///< over every state and output of both nodes at every tick
  TimePoint began_at{};
  Duration virtual_span{};
  surgeon::ScriptOutcome outcome{};
  judge::RunMetrics metrics;
  std::vector<judge::RunTick> ticks;  ///< while the script was performed
  std::vector<DepthEstimate> depths;  ///< one per stroke, in order
  MapReport map;                      ///< the last; number 0: touches at too few places
  /// Theirs, since the start of the run, as the hand made them: less the way to the tip.
  std::vector<judge::Stay> strokes;
  LinkHealth surgeon_link;
  LinkHealth patient_link;
  std::uint64_t records{};  ///< written to both session files
};

/// Runs the scenario on the caller's thread. Deterministic.
[[nodiscard]] RunResult simulate(const Scenario& scenario, const RunFiles& files = {});

}  // namespace palp::lab
