#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/record/recorder.h"
#include "common/record/session_reader.h"
#include "judge/motion.h"

namespace palp::review {

/// A session as the link's words begin it.
struct SessionSpan {
  std::uint64_t id{};
  TimePoint began_at{};
};

/// From then on the hand is in this phase of its script: 1, 2, ...
struct PhaseChange {
  TimePoint at{};
  std::uint32_t phase{};
};

/// What one session file says, in memory.
struct SiteData {
  link::Role site{};
  TimePoint began_at{};  ///< the earliest sample
  std::vector<judge::Motion> motion;
  std::vector<SiteState> states;    ///< one for each of `motion`
  std::vector<PhaseChange> phases;  ///< surgeon: of a scripted hand
  std::vector<Note> notes;
  std::vector<SessionSpan> sessions;
  record::WallClock clock;
  std::vector<Transition> transitions;
  std::vector<DepthEstimate> estimates;
  std::vector<Duration> round_trips;  ///< of the link's statuses, where measured
  std::optional<LinkStatus> last_link;
  std::vector<LinkStatus> links;               ///< all of them
  std::vector<DepthArrived> reports;           ///< surgeon: each estimate as it arrived
  std::vector<PlantTruth> truths;              ///< surgeon: of a simulation of both sites
  record::McapMap metadata;                    ///< of the record `palp`
  record::McapMap peer;                        ///< of the record `palp.peer`
  std::optional<std::string> tissue_csv;       ///< attachment tissue.csv
  std::optional<std::string> settings;         ///< attachment config.textproto
  std::optional<std::string> program_report;   ///< of the program, as JSON, where it was closed
  std::uint64_t records{};                     ///< decoded
  std::optional<std::string> records_dropped;  ///< from the summary
  record::McapReadReport report;

  [[nodiscard]] std::optional<std::string> entry(const std::string& key) const;
  /// nullopt: absent, or not a finite number.
  [[nodiscard]] std::optional<double> number(const std::string& key) const;
};

/// Fails if the file cannot be opened, is none, or is the other site's.
[[nodiscard]] Result<SiteData> load_site(const std::string& path, link::Role site);
[[nodiscard]] Result<SiteData> load_site(const record::FileBytes& file,
                                         const std::string& name,
                                         link::Role site);

}  // namespace palp::review
