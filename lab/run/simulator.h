#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/time.h"

namespace palp::lab {

/// Virtual time: runs tickers in due order (ties: order of registration) on the caller's thread.
/// Nothing waits, so a session runs as fast as its parts compute. Owns the functions, not what
/// they refer to.
class Simulator final : public Clock {
 public:
  struct Ticker {
    Duration period{};  ///< > 0
    Duration phase{};   ///< >= 0, of the first tick after the start
  };

  Simulator();

  /// `tick` is called with the time at which it is due.
  void every(const Ticker& ticker, std::function<void(TimePoint)> tick);

  /// Runs every tick that is due before now() + span, then moves now() there.
  void run_for(Duration span);

  [[nodiscard]] TimePoint now() const noexcept override { return now_; }

 private:
  struct Entry {
    TimePoint due{};
    Duration period{};
    std::function<void(TimePoint)> tick;
  };

  std::vector<Entry> entries_;
  TimePoint now_{};
};

}  // namespace palp::lab
