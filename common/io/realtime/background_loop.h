#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "common/core/time.h"

namespace palp::io {

/// The counterpart of the periodic loop without a deadline: a thread of ordinary priority that
/// calls `work` with pauses of `pause` between. It may allocate, wait and write files: the record
/// thread, the estimator. What `work` refers to must outlive it. Thread: its maker's.
class BackgroundLoop {
 public:
  BackgroundLoop(const std::string& name, Duration pause, std::function<void(TimePoint now)> work);
  /// Stops and waits; a failure is swallowed, so call stop() where it matters.
  ~BackgroundLoop();
  BackgroundLoop(const BackgroundLoop&) = delete;
  BackgroundLoop& operator=(const BackgroundLoop&) = delete;

  /// Ends the pause, lets `work` run once more from beginning to end, so that what was queued
  /// before this call is done, and waits. Idempotent.
  /// @throws what `work` threw, if it did: the loop ended there.
  void stop();
  /// stop(), for `work` that a disk may hold up for ever: waits `patience` for it to come back.
  /// @returns false: it did not. The thread is left to itself then, and `work` must own what it
  /// refers to.
  [[nodiscard]] bool stop_within(Duration patience);
  /// What `work` threw, if it did: nothing is done any more. Not after a stop_within() that failed.
  [[nodiscard]] std::optional<std::string> failure() const;

 private:
  struct Ending;

  std::unique_ptr<Ending> ending_;
  std::jthread thread_;
};

}  // namespace palp::io
