#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/json.h"
#include "judge/metrics.h"
#include "judge/tissue_table.h"
#include "review/time_line.h"

namespace palp::review {

/// A session as the judge of the lab's runs sees one: by its true states, where the lab wrote them
/// down, else by what both sites wrote down. What nobody wrote down is not a number.
struct SessionTicks {
  std::vector<judge::RunTick> ticks;
  bool phases{};  ///< the script that the hand followed is known, and with it taps and holds
  /// A session of the lab: judged by what is true in it, as are `ticks`, and as the lab judged it.
  std::optional<judge::RunMetrics> of_truth;
  TimePoint run_began{};  ///< of such a session, the surgeon's time
};

/// `tissue`: null: unknown, and with it what is true.
[[nodiscard]] SessionTicks session_ticks(const SessionPair& session,
                                         const judge::TissueTable* tissue);

/// The lab's metrics of a session.
[[nodiscard]] judge::RunMetrics session_metrics(const SessionTicks& session);

/// As reports have them, under the names of the lab's reports.
[[nodiscard]] config::Json metrics_json(const SessionTicks& session);

}  // namespace palp::review
