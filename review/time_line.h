#pragma once

#include <string>

#include "common/core/result.h"
#include "review/site_data.h"

namespace palp::review {

/// The surgeon's line of time, on which the patient's instants are laid.
struct TimeLine {
  Duration offset{};       ///< patient's time - surgeon's, at `at`
  double skew{};           ///< [s/s], the patient's clock gains so much
  TimePoint at{};          ///< of the surgeon's
  Duration uncertainty{};  ///< of the offset
  bool known{};            ///< false: nothing says how the clocks lie; the offset is 0
  std::string source;      ///< for people: how the offset is known

  /// The surgeon's instant of the patient's.
  [[nodiscard]] TimePoint surgeons(TimePoint patients) const noexcept;
};

/// By the clock offsets that the sites logged: the most certain one, the latest of those; else by
/// the wall clocks of both files.
[[nodiscard]] TimeLine time_line_of(const SiteData& surgeon, const SiteData& patient);

/// A session's data of both sites: what lies before or after it is left out.
struct SessionPair {
  SiteData surgeon;
  SiteData patient;
  TimeLine time_line;
  std::string session_id;  ///< empty: neither file names one
};

/// Fails where both files name sessions and none is the same: with the ids of both.
[[nodiscard]] Result<SessionPair> pair_of(SiteData surgeon, SiteData patient);
/// What the files lack, a line of text for each that lacks something.
[[nodiscard]] std::string lack_lines(const SessionPair& session);
/// pair_of() two files, by their names.
[[nodiscard]] Result<SessionPair> load_pair(const std::string& surgeon, const std::string& patient);

}  // namespace palp::review
