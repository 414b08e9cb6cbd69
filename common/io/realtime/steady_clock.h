#pragma once

#include "common/core/time.h"

namespace palp::io {

/// The only reader of the system's monotonic clock; its line starts at boot. Thread: any.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] TimePoint now() const noexcept override;
  /// Sleeps until `deadline`; returns at once if it has passed.
  void sleep_until(TimePoint deadline) const noexcept;
  /// Sleeps for so long.
  void pass(Duration span) const noexcept { sleep_until(now() + span); }
};

}  // namespace palp::io
