#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/record/recorder.h"

namespace palp::system_test {

/// What the tests look at in a session file, in the order of the file.
struct SessionFile {
  std::vector<SiteTick> ticks;
  std::vector<Transition> transitions;
  std::vector<TimePoint> arrivals;  ///< at the socket, of every sample of the peer
  std::uint64_t messages{};         ///< views included
  bool closed{};
};

/// An empty one, and a failure of the test, if the file cannot be opened.
[[nodiscard]] SessionFile read_session(const std::string& path);

/// The first change to `state` at or after `since`.
[[nodiscard]] std::optional<TimePoint> change_to(const SessionFile& file,
                                                 SiteState state,
                                                 TimePoint since = {});

/// The newest arrival before `instant`.
[[nodiscard]] TimePoint last_arrival_before(const SessionFile& file, TimePoint instant);

struct ForceStep {
  double force{};  ///< [N], largest change of the commanded force between ticks `span` apart
  TimePoint at{};
  SiteState state{};  ///< where it ended
};
[[nodiscard]] ForceStep largest_force_step(const SessionFile& file, Duration span);

/// Writes `text` to a new file.
void write_text(const std::string& path, const std::string& text);

}  // namespace palp::system_test
