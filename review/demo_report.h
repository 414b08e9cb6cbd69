#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/json.h"
#include "common/core/result.h"
#include "review/site_data.h"
#include "review/taps.h"
#include "review/time_line.h"

namespace palp::review {

/// What the caller of a session asked for; a session file cannot know it.
struct Asked {
  std::string outcome{};  ///< empty: nobody said
  std::string preset{};   ///< empty: nobody said
  std::string grip{};     ///< empty: nobody said
  std::optional<double> rtt_ms{};
  std::optional<double> jitter_ms{};
  std::optional<double> loss{};  ///< [-], share
};

/// Texts of the reports that the programs of a session wrote; empty: absent. What they would have
/// said is then taken from the session files where these know it, else null.
struct ProgramReports {
  std::string surgeon{};  ///< palp.site/2
  std::string patient{};  ///< palp.site/2
  std::string relay{};    ///< palp.relay/1
};

/// Fails where a report is not of the program that wrote the session file: of the other site, or
/// with another figure than the file holds of its program. What a file does not tell is believed,
/// but a simulation has no report of a site.
[[nodiscard]] Result<void> check_reports(const SessionPair& session, const ProgramReports& reports);

struct SessionPaths {
  std::string surgeon;
  std::string patient;
};

/// The JSON document `palp.demo/1`. `metrics`: as metrics_json().
[[nodiscard]] std::string demo_report(const SessionPair& session,
                                      const Touches& touches,
                                      const Asked& asked,
                                      const ProgramReports& reports,
                                      const SessionPaths& paths,
                                      const config::Json& metrics = nullptr);

}  // namespace palp::review
