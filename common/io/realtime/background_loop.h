#pragma once

#include <exception>
#include <functional>
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

 private:
  void run(const std::stop_token& stop,
           Duration pause,
           const std::function<void(TimePoint now)>& work);

  std::exception_ptr failure_;  ///< written by the thread, read after it has ended
  std::jthread thread_;
};

}  // namespace palp::io
