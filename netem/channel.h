#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/core/histogram.h"
#include "common/core/time.h"
#include "netem/fate.h"
#include "netem/impairment.h"

namespace palp::netem {

/// pushed + copies = popped + lost + blackout + over_limit + in flight, at any moment.
struct ChannelCounters {
  std::uint64_t pushed{};  ///< datagrams that arrived
  std::uint64_t copies{};  ///< duplicates made of them
  std::uint64_t popped{};
  std::uint64_t lost{};
  std::uint64_t blackout{};
  std::uint64_t over_limit{};  ///< line full, datagram too long, or nobody collected
  std::uint64_t reordered{};   ///< originals popped after one that had arrived later
  std::uint64_t floored{};     ///< delays lifted to the law's floor
};

/// A datagram that leaves the channel.
struct Released {
  std::size_t size{};  ///< [bytes]
  TimePoint arrived_at{};
  TimePoint released_at{};  ///< as decided, however late it is collected
  std::uint64_t index{};    ///< of the datagram, in order of arrival from 0
  bool duplicate{};
};

/// One direction of an impaired path; the same object under real sockets and in virtual time. It
/// holds the datagrams whose fates FateSequence decides.
/// What leaves, when and in what order depends on the pushes alone, never on how often anybody
/// pops. At most `in_flight_max` datagrams are on their way; somewhat more may wait, due, for a
/// host that does not collect them.
/// Thread: its owner's, fit for rt: all memory is taken by the constructor.
class Channel {
 public:
  /// `start`: where the blackouts' times begin. The impairment must be one that
  /// parse_impairment could have made; in_flight_max > 0.
  Channel(const Impairment& impairment,
          std::uint64_t seed,
          Direction direction,
          std::size_t in_flight_max,
          TimePoint start = {});

  /// A datagram arrives. A `now` before the newest one counts as that.
  void push(std::span<const std::byte> datagram, TimePoint now) noexcept;

  /// @returns nullopt: the channel is empty.
  [[nodiscard]] std::optional<TimePoint> next_release() const noexcept;

  /// The next datagram due at `now`, cut off at the size of `out`. @returns nullopt: nothing due.
  std::optional<Released> pop(std::span<std::byte> out, TimePoint now) noexcept;

  [[nodiscard]] const ChannelCounters& counters() const noexcept { return counters_; }
  /// Inside the channel: on their way, or due and not collected.
  [[nodiscard]] std::size_t in_flight() const noexcept {
    return line_.size() + heap_.size() + due_.size();
  }
  /// Delays as the law drew them, of what was delivered.
  [[nodiscard]] const Histogram& intended_delay() const noexcept { return intended_; }
  /// Release minus arrival, of what was popped: with order keep also the wait behind others.
  [[nodiscard]] const Histogram& achieved_delay() const noexcept { return achieved_; }

 private:
  struct Entry {
    TimePoint release{};
    std::uint64_t number{};  ///< breaks ties: first in, first out
    std::uint32_t slot{};
  };
  struct Slot {
    std::size_t size{};  ///< [bytes]
    TimePoint arrived_at{};
    std::uint64_t index{};
    bool duplicate{};
  };

  /// First in, first out, in a block of fixed size.
  template <class T>
  class Ring {
   public:
    explicit Ring(std::size_t capacity) : items_(capacity) {}
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] const T& front() const noexcept { return items_[first_]; }
    [[nodiscard]] const T& back() const noexcept { return items_[wrap(first_ + count_ - 1)]; }
    void push(const T& item) noexcept { items_[wrap(first_ + count_++)] = item; }
    void pop() noexcept {
      first_ = wrap(first_ + 1);
      --count_;
    }

   private:
    [[nodiscard]] std::size_t wrap(std::size_t at) const noexcept {
      return at < items_.size() ? at : at - items_.size();
    }
    std::vector<T> items_;
    std::size_t first_{};
    std::size_t count_{};
  };

  static bool later(const Entry& left, const Entry& right) noexcept {
    return left.release != right.release ? left.release > right.release
                                         : left.number > right.number;
  }
  [[nodiscard]] const Entry* first_on_way() const noexcept;
  Entry take_first_on_way() noexcept;
  void settle(TimePoint now) noexcept;
  void place(std::span<const std::byte> datagram, const Slot& slot, TimePoint release) noexcept;

  FateSequence fates_;
  std::size_t in_flight_max_;
  std::size_t slot_count_;
  TimePoint last_arrival_{};

  Ring<Entry> due_;          ///< released before the newest arrival, not yet collected
  Ring<Entry> line_;         ///< on their way, sorted as they came: all, if nothing overtakes
  std::vector<Entry> heap_;  ///< on their way, those that overtake
  /// A heap of releases after the newest arrival that were collected already: they still take
  /// room, so that the limit does not depend on when somebody collects.
  std::vector<TimePoint> collected_;
  std::uint64_t number_{};

  std::unique_ptr<std::byte[]> bytes_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;  ///< a stack: few slots stay warm

  ChannelCounters counters_;
  std::uint64_t index_next_{};  ///< one above the highest original popped
  Histogram intended_;
  Histogram achieved_;
};

}  // namespace palp::netem
