#pragma once

#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/message/depth.h"
#include "common/message/map_report.h"
#include "common/record/recorder.h"
#include "depth/depth_estimator.h"

namespace palp::patient {

/// Runs the depth estimator beside the node: takes its samples from a queue, leaves estimates in a
/// mailbox, and records them: each stroke's depth, and what all strokes say together.
/// Thread: estimator's, or the lab's; whoever calls drain(). Owns the estimator; the rest outlives
/// it. The recorder is its own, not the node's.
class EstimatorWorker {
 public:
  struct Parts {
    SpscQueue<ContactSample>& contact;  ///< writer: rt; reader: this
    Mailbox<Findings>& found;           ///< writer: this; reader: rt
    Mailbox<MapCells>& cells;           ///< writer: this; reader: rt
    record::Recorder& recorder;
  };

  EstimatorWorker(const depth::DepthEstimatorConfig& config, Parts parts);

  /// Works on what waits in the queue. @returns how many samples there were.
  std::size_t drain();
  /// What the strokes at all places say together, where the last one is news: a longer work, for
  /// after drain().
  void judge_map();

  [[nodiscard]] std::uint64_t strokes() const noexcept { return strokes_; }
  /// Of the sample that showed the last stroke's reversal.
  [[nodiscard]] TimePoint reversal_at() const noexcept { return reversal_at_; }
  [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
  [[nodiscard]] std::uint64_t records_lost() const noexcept { return records_lost_; }

 private:
  void publish(const DepthEstimate& estimate);
  void record(const Record& record);

  depth::DepthEstimator estimator_;
  Parts parts_;
  Findings found_;
  MapCells cells_;
  std::uint64_t strokes_{};
  TimePoint reversal_at_{};
  std::uint64_t records_{};
  std::uint64_t records_lost_{};
};

}  // namespace palp::patient
