#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/core/time.h"
#include "common/message/port_sample.h"

namespace palp::surgeon {

/// Holds what arrived back, so that touch is as old as the picture beside it: a delay of the way
/// here that the law sees as any other. It is reached slowly, or a hand would feel it change.
/// Nothing is lost, and the order stays. Thread: rt; constant memory.
class SampleHold {
 public:
  static constexpr Duration kMax = std::chrono::milliseconds{100};
  static constexpr double kSlew = 0.02;       ///< [s/s], of the hold
  static constexpr std::size_t kKept = 1024;  ///< more than arrive in kMax; beyond, none is held

  SampleHold() { waiting_.reserve(kKept); }

  /// What is let through now, oldest first: each `wanted` [0, kMax] after it arrived, in the end.
  /// Once a tick. Valid until the next call.
  [[nodiscard]] std::span<const Incoming> pass(std::span<const Incoming> arrived,
                                               Duration wanted,
                                               TimePoint now) noexcept;
  /// What waits is of an epoch that has ended.
  void forget() noexcept;

  [[nodiscard]] Duration hold() const noexcept { return hold_; }

 private:
  std::vector<Incoming> waiting_;  ///< by arrival; never beyond the reserved size
  std::size_t passed_{};           ///< so many of them were let through in the last call
  Duration hold_{};
  TimePoint ticked_at_{};
};

}  // namespace palp::surgeon
