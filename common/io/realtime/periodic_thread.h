#pragma once

#include <functional>
#include <string>
#include <thread>

#include "common/core/mailbox.h"
#include "common/io/realtime/periodic_loop.h"

namespace palp::io {

/// A thread of its own that runs run_periodic(): the rt thread of a site. What `tick` refers to
/// must outlive it; declare it last. Thread: its maker's, which is also the reader of progress().
class PeriodicThread {
 public:
  /// Returns once the system has said what it grants; the first tick follows a period later.
  PeriodicThread(const std::string& name,
                 const LoopConfig& config,
                 std::function<void(TimePoint now)> tick,
                 std::function<void()> warm_up = {});
  /// Stops and waits.
  ~PeriodicThread();
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  [[nodiscard]] const RealtimeGrant& grant() const noexcept { return grant_; }
  /// After the newest finished tick.
  [[nodiscard]] LoopProgress progress() noexcept { return progress_.get(); }
  /// Waits for the tick at work, then for the thread. @returns the account, also when repeated.
  const LoopStats& stop();

 private:
  Mailbox<LoopProgress> progress_;  ///< writer: the loop's thread, reader: the maker's
  RealtimeGrant grant_;
  LoopStats stats_;
  std::jthread thread_;
};

}  // namespace palp::io
