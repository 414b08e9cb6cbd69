#pragma once

#include <cstddef>

#include "common/core/time.h"
#include "netem/model/impairment.h"

namespace palp::netem {

/// Looks delays up in a trace, for times that mostly rise. Thread: its owner's, fit for rt.
class TraceReader {
 public:
  /// Another trace, or the same from its beginning.
  void rewind() noexcept { at_ = 0; }
  /// Of what is sent so long after the trace's start. The arrival time, sent + delay, is
  /// interpolated, not the delay: so a stall keeps its shape, hold and then a bunch, and order is
  /// kept. @pre at least two points.
  [[nodiscard]] Duration delay(const DelayTrace& trace, Duration since) noexcept;

 private:
  std::size_t at_{};  ///< the segment looked up last
};

}  // namespace palp::netem
