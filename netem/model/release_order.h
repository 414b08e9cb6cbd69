#pragma once

#include <array>
#include <cstdint>

#include "common/core/time.h"
#include "netem/model/impairment.h"

namespace palp::netem {

/// Mode exact: in which order datagrams leave. Thread: its owner's, fit for rt.
class ReleaseOrder {
 public:
  /// From the next datagram on; those before it still count.
  void change(const Impairment& law) noexcept {
    order_ = law.order;
    swap_depth_ = law.swap_depth;
  }
  /// When one leaves that came at `arrived` and is due at `release`. `swaps`: order Swap: it leaves
  /// just before those that it overtakes.
  [[nodiscard, gnu::always_inline]] TimePoint fit(TimePoint release,
                                                  TimePoint arrived,
                                                  bool swaps) noexcept {
    if (order_ == Order::Swap) return fit_swapped(release, arrived, swaps);
    if (order_ != Order::Keep) return release;
    // Which of the two it is cannot be foreseen: no branch.
    const TimePoint last = last_;
    release = release < last ? last : release;
    last_ = release;
    return release;
  }

 private:
  [[nodiscard]] TimePoint fit_swapped(TimePoint release, TimePoint arrived, bool swaps) noexcept;

  Order order_{Order::Keep};
  std::uint32_t swap_depth_{};
  TimePoint last_{};
  std::array<TimePoint, kSwapDepthMax> releases_{};  ///< order Swap: of the last ones, a ring
  std::uint64_t released_{};
};

}  // namespace palp::netem
