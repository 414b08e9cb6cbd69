#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/time.h"
#include "netem/model/bottleneck.h"
#include "netem/model/chance_draw.h"
#include "netem/model/delay_sequence.h"
#include "netem/model/impairment.h"
#include "netem/model/packet_outcome.h"
#include "netem/model/path_conditions.h"
#include "netem/model/prepared_law.h"
#include "netem/model/recording_reader.h"
#include "netem/model/release_order.h"
#include "netem/model/slot_grid.h"

namespace palp::netem {

/// ImpairmentModel's mode exact: what the numbers say. The parts act independently, in this order:
/// duplicate, blackout, losses, length, flipped bits, stall, rate and queue, delay, order, slot.
/// Thread: its owner's, fit for rt.
class ExactModel {
 public:
  ExactModel(const PreparedLaw& law, const Streams& streams, TimePoint start);

  [[nodiscard]] std::span<const CopyOutcome> next(const Arrival& arrival) noexcept;
  /// From the next datagram on; `law` outlives this object or the next change.
  void change(const PreparedLaw& law) noexcept;

  /// Copies beside those of the law, of each datagram from now on: a flood. Below kCopiesMax - 1.
  void flood(std::size_t copies) noexcept {
    flood_ = copies;
    chances_.wake();
  }
  /// Delay, jitter and random losses go this share of the way towards those of another law; what
  /// is going on, a run of losses say, goes on.
  void lean(const PreparedLaw& towards, double share) noexcept;

 private:
  [[nodiscard]] CopyOutcome untouched(const Arrival& arrival) const noexcept;
  [[nodiscard]] std::size_t next_troubled(const Arrival& arrival, TimePoint at) noexcept;
  void go_on(CopyOutcome& outcome,
             std::size_t copy,
             const Chances& chances,
             TimePoint onward,
             bool room) noexcept;
  void harm(CopyOutcome& outcome,
            std::size_t copy,
            const Chances& chances,
            const PathCondition& path) const noexcept;
  [[nodiscard]] bool lost(std::size_t copy,
                          const Chances& chances,
                          const PathCondition& path) const noexcept;
  void damage(CopyOutcome& outcome, std::size_t copy, const Chances& chances) const noexcept;
  [[nodiscard]] bool fits(const CopyOutcome& outcome) const noexcept;
  void leave(CopyOutcome& outcome, const Chances& chances, TimePoint onward) noexcept;

  const PreparedLaw* law_;
  Streams streams_;
  std::uint64_t index_{};  ///< of the datagram being judged
  TimePoint last_at_{};
  bool first_{true};
  std::size_t flood_{};
  std::array<CopyOutcome, kCopiesMax> copies_;

  ChanceDraw chances_;
  PathConditions path_;
  Bottleneck bottleneck_;
  DelaySequence delays_;
  ReleaseOrder order_;
  SlotGrid slots_;
  RecordingReader recording_;
};

}  // namespace palp::netem
