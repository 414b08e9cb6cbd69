#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/json.h"
#include "judge/excursions.h"
#include "judge/metrics.h"
#include "judge/tissue_table.h"
#include "review/time_line.h"

namespace palp::review {

/// A session as the judge of the lab's runs sees one: by its true states, where the lab wrote them
/// down, else by what both sites wrote down. What nobody wrote down is not a number.
struct JudgedSession {
  judge::RunMetrics metrics;
  bool phases{};    ///< the script that the hand followed is known, and with it taps and holds
  bool by_truth{};  ///< a session of the lab: judged as the lab judged it
  TimePoint run_began{};                     ///< of such a session, the surgeon's time
  std::vector<judge::Excursion> excursions;  ///< of the hand
};

/// The tissue of the patient's file; nothing: it holds none. `path`: of that file, for a sentence.
[[nodiscard]] Result<std::optional<judge::TissueTable>> tissue_of(const SiteData& patient,
                                                                  const std::string& path);

/// Sees each tick of a session, as it is judged, in order of time.
class TickWatcher {
 public:
  TickWatcher() = default;
  TickWatcher(const TickWatcher&) = delete;
  TickWatcher& operator=(const TickWatcher&) = delete;
  virtual ~TickWatcher() = default;
  virtual void see(const judge::RunTick& tick) = 0;
};

/// Reads the ticks of both files once more, from the first to the last; holds none.
/// `tissue`: null: unknown, and with it what is true. `watcher`: null: nobody.
[[nodiscard]] JudgedSession judge_session(const SessionPair& session,
                                          const judge::TissueTable* tissue,
                                          TickWatcher* watcher = nullptr);

/// As reports have them, under the names of the lab's reports.
[[nodiscard]] config::Json metrics_json(const JudgedSession& session);

}  // namespace palp::review
