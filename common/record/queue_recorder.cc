#include "common/record/queue_recorder.h"

namespace palp::record {

QueueRecorder::QueueRecorder(std::size_t capacity) : queue_{capacity} {
  // Touch every slot now: the first lap of rt must not be the one that gets the pages.
  while (queue_.try_enqueue(Record{})) {
  }
  while (queue_.pop()) {
  }
}

bool QueueRecorder::record(const Record& record) noexcept {
  if (queue_.try_enqueue(record)) {
    return true;
  }
  dropped_for_reader_.put(++dropped_);
  return false;
}

}  // namespace palp::record
