#pragma once

#include <cstddef>
#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/record/recorder.h"

namespace palp::record {

/// Carries records from one thread (rt, or the estimator's) to the record thread. A full queue
/// drops the record and counts it; the writer never waits.
class QueueRecorder final : public Recorder {
 public:
  /// 16384 records: 3 s of a site that logs 5 of them per tick.
  explicit QueueRecorder(std::size_t capacity = 16384);

  /// Thread: rt (the one writer).
  bool record(const Record& record) noexcept override;

  /// Gives every waiting record to `take`, oldest first. Thread: record (the one reader).
  /// @returns how many there were.
  template <class Take>
  std::size_t drain(Take&& take) {
    std::size_t count = 0;
    while (const Record* record = queue_.peek()) {
      take(*record);
      queue_.pop();
      ++count;
    }
    return count;
  }

  /// Records lost so far. Thread: record (the one reader).
  [[nodiscard]] std::uint64_t dropped() noexcept { return dropped_for_reader_.get(); }

 private:
  SpscQueue<Record> queue_;
  std::uint64_t dropped_{};                    ///< writer's
  Mailbox<std::uint64_t> dropped_for_reader_;  ///< written by rt, read by record
};

}  // namespace palp::record
