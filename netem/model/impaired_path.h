#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/time.h"
#include "netem/model/decision.h"
#include "netem/model/flight_queue.h"
#include "netem/model/impairment_model.h"
#include "netem/model/kernel_slots.h"
#include "netem/model/path_plan.h"
#include "netem/model/place_pool.h"
#include "netem/model/plan_cursor.h"
#include "netem/model/ring.h"

namespace palp::netem {

/// How many may be on their way; tc's default in mode netem-6.1, else none.
[[nodiscard]] std::size_t limit_of(const Impairment& impairment) noexcept;

/// Whether somebody may leave before one who came earlier.
[[nodiscard]] bool may_overtake(const Impairment& impairment) noexcept;

/// One direction of an impaired path without the bytes: who arrives, what becomes of it, who leaves
/// when. The decisions depend on the arrivals alone, never on how often anybody looks.
/// At most `in_flight_max` datagrams are on their way, fewer if the impairment says so; somewhat
/// more may wait, due, for a host that does not collect them.
/// Thread: its owner's, fit for rt: all memory is taken by the constructor.
class ImpairedPath {
 public:
  /// `start`: where the times of the plan begin. `waiting_max`: places for what is due.
  ImpairedPath(const PathPlan& plan,
               std::uint64_t seed,
               Direction direction,
               std::size_t in_flight_max,
               std::size_t waiting_max,
               TimePoint start);

  /// A datagram of `length` bytes of payload arrives; a time before the newest one counts as that.
  /// @returns what becomes of it and its copies; those that are delivered are on their way, each
  /// in its `place`. Valid until the next call.
  // NOLINTNEXTLINE(bugprone-exception-escape): as ImpairmentModel::next()
  [[nodiscard]] std::span<const Decision> push(const Arrival& arrival) noexcept;

  /// When the next one leaves. @returns nullopt: nobody is on the way.
  [[nodiscard]] std::optional<TimePoint> next_release() const noexcept;
  /// How many leave by `at` without overtaking anybody, `most` at the most: a host's effort.
  [[nodiscard]] std::size_t in_line_by(TimePoint at, std::size_t most) const noexcept;
  /// The next one due at `now`; its place is free again at the next push.
  [[nodiscard]] std::optional<Decision> pop(TimePoint now) noexcept;

  /// Applies a change now, behind those that the plan has up to now; the next datagram is the first
  /// to feel it. What it needs no more comes back in `change`, to be freed elsewhere.
  void apply(PreparedChange& change, TimePoint now) noexcept;

  /// On their way, or due and not collected.
  [[nodiscard]] std::size_t in_flight() const noexcept { return flying_.size() + due_.size(); }
  [[nodiscard]] std::size_t places() const noexcept { return places_.capacity(); }
  [[nodiscard]] const Impairment& impairment() const noexcept { return model_.law().impairment; }
  /// From the start, those of the plan's rounds that nobody saw included.
  [[nodiscard]] std::uint64_t changes_applied() const noexcept {
    return changes_acted_ + plan_.skipped();
  }
  [[nodiscard]] std::uint64_t rebinds() const noexcept { return rebinds_; }
  /// Which law holds for who comes at `at`, on a ramp the one where it leads: 0: the plan's first;
  /// 1, 2 ..: that of the plan's change of this place, from 1; else what the change from outside
  /// said.
  [[nodiscard]] std::uint64_t law_number(TimePoint at) const noexcept {
    return plan_.law_number(at, law_number_);
  }

 private:
  /// What changes impose for a while.
  struct Imposed {
    TimePoint dark_until{TimePoint::min()};
    TimePoint held_until{TimePoint::min()};
    TimePoint flood_until{TimePoint::min()};
    bool flood{};
  };
  struct Ramp {
    const PreparedLaw* to{};  ///< null: none is on
    TimePoint from{};
    Duration span{};
  };

  void hold_law() noexcept;
  void act(const PreparedChange& change, TimePoint now) noexcept;
  void apply_due(TimePoint at) noexcept;
  void lean(TimePoint at) noexcept;
  [[nodiscard]] std::size_t room() const noexcept;
  void settle(TimePoint now) noexcept;
  void let_out(TimePoint now) noexcept;
  void enter(Decision& decision, bool immediate) noexcept;

  ImpairmentModel model_;
  std::size_t in_flight_max_;
  std::size_t limit_;
  TimePoint last_arrival_;
  std::uint64_t index_{};

  PlanCursor plan_;
  std::uint64_t changes_acted_{};
  std::uint64_t rebinds_{};
  std::uint64_t law_number_{};  ///< as applied
  Imposed imposed_;
  Ramp ramp_;
  /// Of changes from outside, which are their hosts' until then: what holds, and where a ramp
  /// leads. Each stays here until the next one of its kind takes its place.
  std::unique_ptr<PreparedLaw> own_law_;
  std::unique_ptr<PreparedLaw> own_ramp_;

  std::array<Decision, kCopiesMax> decisions_;
  Ring<InFlight> due_;  ///< released before the newest arrival, not yet collected
  FlightQueue flying_;
  /// A heap of releases after the newest arrival that were collected already: they still take
  /// room, so that the limit does not depend on when somebody collects.
  std::vector<TimePoint> collected_;
  RandomStream slot_stream_;
  std::optional<KernelSlots> kernel_slots_;
  PlacePool places_;
};

}  // namespace palp::netem
