#pragma once

#include <chrono>
#include <optional>

#include "common/core/time.h"
#include "site_program/exit_status.h"
#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

/// How a script that is over ends the program; nullopt: it is not over, or there is none.
[[nodiscard]] std::optional<site_program::ExitStatus> end_of_script(const SurgeonStatus& status);
/// How the time that was asked for ends it: a site that stands still in the end has not done what
/// it was there for.
[[nodiscard]] site_program::ExitStatus end_of_time(const SurgeonStatus& status);

/// A script waits until it may engage, and nobody but a person frees a site that is stopped. This
/// one knows when to give up. Told the time. Thread: main.
class StoppedPeerWatch {
 public:
  explicit StoppedPeerWatch(Duration patience = std::chrono::seconds{10}) : patience_{patience} {}
  /// `scripted`: no person is at the hand. nullopt: go on.
  [[nodiscard]] std::optional<site_program::ExitStatus> judge(const SurgeonStatus& status,
                                                              bool scripted,
                                                              TimePoint now);

 private:
  Duration patience_;
  std::optional<TimePoint> since_;
};

}  // namespace palp::surgeon
