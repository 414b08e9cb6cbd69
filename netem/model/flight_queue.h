#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/time.h"
#include "netem/model/ring.h"

namespace palp::netem {

/// A datagram on its way, or due.
struct InFlight {
  TimePoint::rep release_ns;
  std::uint32_t number;  ///< breaks ties: first in, first out; it may come round
  std::uint32_t place;   ///< in a PlacePool
  [[nodiscard]] TimePoint release() const noexcept { return TimePoint{Duration{release_ns}}; }
};

/// Datagrams on their way, in the order of their releases; of the same release, as they came.
/// Thread: its owner's, fit for rt: all memory is taken by the constructor.
class FlightQueue {
 public:
  explicit FlightQueue(std::size_t capacity) : line_{capacity} { heap_.reserve(capacity); }

  [[nodiscard]] std::size_t size() const noexcept { return line_.size() + heap_.size(); }
  /// The one whose turn is next. @returns null: nobody is on the way. Valid until the next change.
  [[nodiscard]] const InFlight* first() const noexcept {
    if (heap_.empty()) return line_.empty() ? nullptr : &line_.front();
    if (line_.empty() || later(line_.front(), heap_.front())) return &heap_.front();
    return &line_.front();
  }
  /// Of those who overtook nobody, in their order; below in_line().
  [[nodiscard]] const InFlight& in_line(std::size_t at) const noexcept { return line_[at]; }
  [[nodiscard]] std::size_t in_line() const noexcept { return line_.size(); }

  /// Takes its number; does not enter it.
  [[nodiscard]] InFlight number(TimePoint release, std::uint32_t place) noexcept {
    return {release.time_since_epoch().count(), number_++, place};
  }
  void push(const InFlight& entry) noexcept {
    if (line_.empty() || line_.back().release_ns <= entry.release_ns) {
      line_.push(entry);
    } else {
      heap_.push_back(entry);
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  }
  /// @pre first() said that there is one.
  InFlight take_first() noexcept {
    if (heap_.empty() || (!line_.empty() && later(heap_.front(), line_.front()))) {
      const InFlight entry = line_.front();
      line_.pop();
      return entry;
    }
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const InFlight entry = heap_.back();
    heap_.pop_back();
    return entry;
  }

 private:
  static bool later(const InFlight& left, const InFlight& right) noexcept {
    return left.release_ns != right.release_ns
               ? left.release_ns > right.release_ns
               : static_cast<std::int32_t>(left.number - right.number) > 0;
  }

  Ring<InFlight> line_;         ///< sorted as they came: all, if nothing overtakes
  std::vector<InFlight> heap_;  ///< those that overtake
  std::uint32_t number_{};
};

}  // namespace palp::netem
