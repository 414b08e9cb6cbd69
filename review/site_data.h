#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/record/mapped_file.h"
#include "common/record/recorder.h"
#include "common/record/session_reader.h"

namespace palp::review {

/// A session as the link's words begin it.
struct SessionSpan {
  std::uint64_t id{};
  TimePoint began_at{};
  std::uint64_t ticks_before{};  ///< of the file, before this one
};

/// What curves and clocks need of a link's status.
struct LinkPoint {
  TimePoint at{};
  LinkState state{};
  Duration round_trip{};
  Duration jitter{};
  Duration delay_out{};
  std::uint64_t lost{};
  std::uint64_t accepted{};
  std::optional<ClockOffset> peer_clock;
};

/// From then on the hand is in this phase of its script: 1, 2, ...
struct PhaseChange {
  TimePoint at{};
  std::uint32_t phase{};
};

/// Kept of each list of a file that holds more: no session of a day does.
inline constexpr std::size_t kListMax = 32768;

struct FileReport : record::McapReadReport {
  std::string lack;  ///< as lack_of() has it
};

/// Attachments and what else a file has once; nothing: it has none.
struct SiteTexts {
  std::optional<std::string> tissue_csv;      ///< attachment tissue.csv
  std::optional<std::string> tissue_words;    ///< attachment tissue.txt
  std::optional<std::string> settings;        ///< attachment config.textproto
  std::optional<std::string> script;          ///< the surgeon's, where it came from a file
  std::optional<std::string> program_report;  ///< of the program, as JSON, where it was closed
};

/// What the touches at all places say together: the last of a file.
struct SiteMap {
  MapReport report;            ///< number 0: none
  std::vector<MapCell> cells;  ///< patient: the stiffness map of it
};

/// What one session file says besides its ticks, which TickSource reads one by one: a file of hours
/// takes no more memory than one of minutes.
struct SiteData {
  link::Role site{};
  record::FileBytes bytes;                      ///< of the file; they outlive this
  std::optional<record::MappedFile> mapping{};  ///< holds them, where they were mapped
  TimePoint began_at{};                         ///< the earliest sample
  TimePoint from{TimePoint::min()};             ///< ticks before are of another session
  TimePoint to{TimePoint::max()};               ///< and from here on
  std::uint64_t ticks{};                        ///< between
  std::vector<PhaseChange> phases;              ///< surgeon: of a scripted hand
  std::vector<Note> notes;
  std::vector<SessionSpan> sessions;
  record::WallClock clock;
  std::vector<Transition> transitions;
  std::vector<DepthEstimate> estimates;
  std::optional<LinkStatus> last_link;
  std::vector<LinkPoint> links;       ///< all of them, or each second, fourth, ...
  std::vector<DepthArrived> reports;  ///< surgeon: each estimate as it arrived
  SiteMap map;
  std::optional<TimePoint> run_began;  ///< surgeon: of a simulation of both sites
  record::McapMap metadata;            ///< of the record `palp`
  record::McapMap peer;                ///< of the record `palp.peer`
  SiteTexts texts;
  std::uint64_t records{};                     ///< decoded
  std::optional<std::string> records_dropped;  ///< from the summary
  FileReport report;

  [[nodiscard]] std::optional<std::string> entry(const std::string& key) const;
  /// nullopt: absent, or not a finite number.
  [[nodiscard]] std::optional<double> number(const std::string& key) const;
};

/// [m], where the patient's surface lies: as the file says, else as the strokes found it.
[[nodiscard]] double surface_of(const SiteData& patient);

/// An attachment; nothing: there is none, or it is longer than any of ours.
[[nodiscard]] std::optional<std::string> text_of(const record::SessionReader& reader,
                                                 const char* name);

/// Fails if the file cannot be opened, is none, or is the other site's.
[[nodiscard]] Result<SiteData> load_site(const std::string& path, link::Role site);
[[nodiscard]] Result<SiteData> load_site(const record::FileBytes& file,
                                         const std::string& name,
                                         link::Role site);

}  // namespace palp::review
