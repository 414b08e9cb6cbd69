#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/time.h"
#include "netem/model/impairment_model.h"
#include "netem/model/kernel_slots.h"
#include "netem/model/path_plan.h"
#include "netem/model/ring.h"

namespace palp::netem {

/// A change that is ready to be applied at any moment.
struct PreparedChange {
  Duration at{};
  Change::Kind kind{};
  Duration span{};
  std::size_t copies{};
  std::unique_ptr<PreparedLaw> law;  ///< Set and Ramp
  std::uint64_t law_number{};        ///< its name, see ImpairedPath::law_number()
};
[[nodiscard]] PreparedChange prepare(const Change& change);

/// How many may be on their way; tc's default in mode netem-6.1, else none.
[[nodiscard]] std::size_t limit_of(const Impairment& impairment) noexcept;

/// Whether somebody may leave before one who came earlier.
[[nodiscard]] bool may_overtake(const Impairment& impairment) noexcept;

/// What happened to one copy of a datagram: a line of the decision log.
struct Decision {
  std::uint64_t index{};  ///< of the datagram, in order of arrival from 0
  std::uint32_t copy{};   ///< 0: the original
  Verdict verdict{};
  bool floored{};
  bool open{};  ///< slots decide when it leaves: its release holds once it is popped
  std::uint8_t tos{};
  std::int32_t flipped_bit{-1};
  std::uint32_t length{};  ///< [bytes] of payload, as it leaves
  std::uint32_t place{};   ///< where its holder keeps it, when it is on its way
  Duration intended{};     ///< delay as the law drew it
  TimePoint arrived_at{};
  TimePoint released_at{};  ///< set when delivered
};

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
  [[nodiscard]] std::size_t in_flight() const noexcept {
    return line_.size() + heap_.size() + due_.size();
  }
  [[nodiscard]] std::size_t places() const noexcept { return places_; }
  [[nodiscard]] const Impairment& impairment() const noexcept { return model_.law().impairment; }
  /// From the start, those of the plan's rounds that nobody saw included.
  [[nodiscard]] std::uint64_t changes_applied() const noexcept { return changes_applied_; }
  [[nodiscard]] std::uint64_t rebinds() const noexcept { return rebinds_; }
  /// Which law holds for who comes at `at`, on a ramp the one where it leads: 0: the plan's first;
  /// 1, 2 ..: that of the plan's change of this place, from 1; else what the change from outside
  /// said.
  [[nodiscard]] std::uint64_t law_number(TimePoint at) const noexcept;

 private:
  struct Entry {
    TimePoint::rep release_ns;
    std::uint32_t number;  ///< breaks ties: first in, first out; it may come round
    std::uint32_t place;
    [[nodiscard]] TimePoint release() const noexcept { return TimePoint{Duration{release_ns}}; }
  };

  static bool later(const Entry& left, const Entry& right) noexcept {
    return left.release_ns != right.release_ns
               ? left.release_ns > right.release_ns
               : static_cast<std::int32_t>(left.number - right.number) > 0;
  }
  void hold_law() noexcept;
  void act(const PreparedChange& change, TimePoint now) noexcept;
  void apply_due(TimePoint at) noexcept;
  void skip_rounds(TimePoint at) noexcept;
  void lean(TimePoint at) noexcept;
  [[nodiscard]] std::size_t room() const noexcept;
  [[nodiscard]] const Entry* first_on_way() const noexcept;
  Entry take_first_on_way() noexcept;
  void settle(TimePoint now) noexcept;
  void let_out(TimePoint now) noexcept;
  void enter(Decision& decision, bool immediate) noexcept;

  ImpairmentModel model_;
  std::size_t in_flight_max_;
  std::size_t limit_;
  TimePoint start_;
  TimePoint last_arrival_;
  std::uint64_t index_{};

  std::vector<PreparedChange> plan_;  ///< its laws stay whole: a round goes on where one ended
  std::size_t plan_at_{};
  Duration plan_shift_{};
  Duration plan_loop_{};
  std::uint64_t changes_applied_{};
  std::uint64_t rebinds_{};
  std::uint64_t law_number_{};  ///< as applied
  const PreparedLaw* ramp_{};   ///< where it leads; null: none is on
  /// Of changes from outside, which are their hosts' until then: what holds, and where a ramp
  /// leads. Each stays here until the next one of its kind takes its place.
  std::unique_ptr<PreparedLaw> own_law_;
  std::unique_ptr<PreparedLaw> own_ramp_;
  TimePoint ramp_from_{};
  Duration ramp_span_{};
  TimePoint dark_until_;
  TimePoint held_until_;
  TimePoint flood_until_;
  bool flooding_{};

  std::array<Decision, kCopiesMax> decisions_;
  Ring<Entry> due_;          ///< released before the newest arrival, not yet collected
  Ring<Entry> line_;         ///< on their way, sorted as they came: all, if nothing overtakes
  std::vector<Entry> heap_;  ///< on their way, those that overtake
  /// A heap of releases after the newest arrival that were collected already: they still take
  /// room, so that the limit does not depend on when somebody collects.
  std::vector<TimePoint> collected_;
  std::uint32_t number_{};
  RandomStream slot_stream_;
  std::optional<KernelSlots> kernel_slots_;

  std::size_t places_;
  std::vector<Decision> held_;              ///< by place; grows to places_ as they are used
  std::vector<std::uint32_t> free_places_;  ///< a stack: few places stay warm
};

}  // namespace palp::netem
