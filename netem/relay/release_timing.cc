#include "netem/relay/release_timing.h"

#include <algorithm>

namespace palp::netem {
namespace {

constexpr Duration kSpinSpare = std::chrono::microseconds{20};
constexpr std::int64_t kSpinMemory = 128;  ///< wakings
constexpr Duration kLeadStep{50};

}  // namespace

Duration ReleaseTiming::lead(std::size_t together) const noexcept {
  if (together < 2) return lead_;
  return std::min(lead_ * static_cast<std::int64_t>(together + 1) / 2, kBunchLeadMax);
}

/// Up at once, down slowly.
void ReleaseTiming::woken(Duration late) noexcept {
  const Duration wanted = std::clamp(late + kSpinSpare, kSpinMin, kSpinMax);
  spin_ = wanted > spin_ ? wanted : spin_ - (spin_ - wanted) / kSpinMemory;
}

/// A step up or down at each call ends where half of the calls take longer.
void ReleaseTiming::sent(Duration each) noexcept {
  lead_ += each > lead_ ? kLeadStep : -kLeadStep;
  lead_ = std::clamp(lead_, Duration{}, kLeadMax);
}

}  // namespace palp::netem
