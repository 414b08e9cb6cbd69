#pragma once

#include <string>

#include "common/core/result.h"
#include "lab/run/run.h"
#include "lab/run/scenario.h"

namespace palp::lab {

/// What a run cost and how it was asked for: the part of a report that is not physics.
struct RunAccount {
  std::string scenario;
  double cpu{};                   ///< [s]
  double wall{};                  ///< [s]
  std::string recording_fault{};  ///< of the session files; empty: none
};

/// Schema palp.run/1, as JSON text.
[[nodiscard]] std::string run_report(const Scenario& scenario,
                                     const RunResult& result,
                                     const RunAccount& account);

/// The same for people: a line per phase and the digest.
[[nodiscard]] std::string run_summary(const Scenario& scenario,
                                      const RunResult& result,
                                      const RunAccount& account);

/// The ticks as CSV: where hand and tip were, what was felt and what is true.
[[nodiscard]] std::string trace_csv(const RunResult& result);

}  // namespace palp::lab
