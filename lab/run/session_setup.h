#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/link/link.h"
#include "common/link/session.h"
#include "lab/run/lab_session.h"
#include "lab/run/local_clock.h"
#include "lab/run/scenario.h"

namespace palp::lab {

/// A site's clock beside the lab's when a run begins.
[[nodiscard]] LocalClock clock_of(const Scenario& scenario, link::Role role) noexcept;

/// How a process and its peer find each other, at every start: by the real handshake where the
/// scenario has a fault, else they know each other from the beginning, and no process dies. Has
/// what outlives a process: its end of the path and its machine's clock. Thread: the lab's. Times
/// are the lab's.
class SessionSetup {
 public:
  SessionSetup(const Scenario& scenario, link::Role role, std::unique_ptr<link::Transport> end);

  /// A process starts; its link lives until it is killed.
  void start(link::Link& link, TimePoint now);
  /// Once a tick, after the node's.
  void step(TimePoint now);
  void kill(TimePoint now);
  /// In place of step() while there is no process: its socket is gone, and so is what comes.
  void lose(TimePoint now);

  [[nodiscard]] LocalClock& clock() noexcept { return clock_; }
  [[nodiscard]] const LocalClock& clock() const noexcept { return clock_; }

 private:
  const Scenario& scenario_;
  link::Role role_;
  std::unique_ptr<link::Transport> end_;  ///< the link's, once it was given away without handshake
  LocalClock clock_;
  std::uint64_t starts_{};
  std::optional<LabSession> lab_session_;
};

}  // namespace palp::lab
