#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/time.h"
#include "netem/model/bottleneck.h"
#include "netem/model/delay_sequence.h"
#include "netem/model/impairment.h"
#include "netem/model/loss_laws.h"
#include "netem/model/packet_outcome.h"
#include "netem/model/prepared_law.h"
#include "netem/model/recording_reader.h"
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
    quiet_end_ = 0;
  }
  /// Delay, jitter and random losses go this share of the way towards those of another law; what
  /// is going on, a run of losses say, goes on.
  void lean(const PreparedLaw& towards, double share) noexcept;

 private:
  /// What befalls the original by chance.
  struct Chances {
    bool duplicate{};
    bool lost{};
    bool swept{};           ///< lost, and all its copies
    double loss_gemodel{};  ///< [1], of each of them
    bool cut{};
    bool flipped{};
    bool jumps{};  ///< goes ahead of its delay
    bool swaps{};  ///< overtakes some
  };
  /// What holds for a datagram and all its copies.
  struct Common {
    TimePoint onward{};  ///< behind the stall
    bool dark{};
    bool lost{};
    double loss_state{};  ///< [1], of Gilbert-Elliott in time
  };
  /// The original's stream is at hand; those of copies are made when needed.
  [[nodiscard]] RandomStream stream_of(RandomStream original,
                                       Stage stage,
                                       std::size_t copy) const noexcept {
    return copy == 0 ? original : streams_.of(stage, copy);
  }
  [[nodiscard]] CopyOutcome untouched(const Arrival& arrival) const noexcept;
  [[nodiscard]] std::size_t next_troubled(const Arrival& arrival, TimePoint at) noexcept;
  void go_on(CopyOutcome& outcome, std::size_t copy, TimePoint onward, bool room) noexcept;
  void catch_up() noexcept;
  void draw_chances() noexcept;
  [[nodiscard]] bool jumps() noexcept;
  [[nodiscard]] Common common_outcome(TimePoint at) noexcept;
  [[nodiscard]] bool in_blackout(TimePoint at) const noexcept;
  [[nodiscard]] TimePoint calm_until(TimePoint at) const noexcept;
  void harm(CopyOutcome& outcome, std::size_t copy, const Common& common) const noexcept;
  [[nodiscard]] bool lost(std::size_t copy, const Common& common) const noexcept;
  void damage(CopyOutcome& outcome, std::size_t copy) const noexcept;
  [[nodiscard]] bool fits(const CopyOutcome& outcome) const noexcept;
  void leave(CopyOutcome& outcome, std::size_t copy, TimePoint onward) noexcept;
  [[nodiscard]] TimePoint swap_order(TimePoint release, bool swaps) noexcept;

  const PreparedLaw* law_;
  Streams streams_;
  TimePoint start_;

  std::uint64_t index_{};  ///< of the datagram being judged
  TimePoint last_at_{};
  bool first_{true};
  std::size_t flood_{};
  std::array<CopyOutcome, kCopiesMax> copies_;
  Chances chances_;            ///< of the datagram being judged
  std::uint64_t quiet_end_{};  ///< below this index no chance strikes
  std::uint64_t asked_{};      ///< up to this index the chances have been asked or told

  ChanceProcess duplicate_;
  ChanceProcess loss_;
  ChanceProcess corrupt_;
  ChanceProcess truncate_;
  ChanceProcess reorder_;
  ChanceProcess swap_;
  FourStateProcess state_;
  GemodelProcess gemodel_;
  BurstProcess burst_;
  GilbertTimeProcess gilbert_;
  StallProcess stall_;
  Bottleneck bottleneck_;

  DelaySequence delays_;
  RandomStream stay_loss_stream_;
  RandomStream gemodel_loss_stream_;
  SlotGrid slots_;
  TimePoint calm_until_{TimePoint::min()};  ///< until then common_fate() has nothing to say
  RecordingReader recording_;
  std::uint32_t since_reorder_{};

  TimePoint last_release_{};
  std::array<TimePoint, kSwapDepthMax> releases_{};  ///< of the last ones, a ring
  std::uint64_t released_{};
};

}  // namespace palp::netem
