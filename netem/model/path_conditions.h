#pragma once

#include <cstdint>

#include "common/core/time.h"
#include "netem/model/impairment.h"
#include "netem/model/loss_laws.h"
#include "netem/model/packet_outcome.h"

namespace palp::netem {

/// What the path does to a datagram and all its copies.
struct PathCondition {
  TimePoint onward{};  ///< behind the stall
  bool dark{};
  bool lost{};
  double loss_state{};  ///< [1], of Gilbert-Elliott in time
  bool operator==(const PathCondition&) const = default;
};

/// Mode exact: what the path does to whoever comes, because of the time at which it comes:
/// blackouts, bursts, Gilbert-Elliott in time, stalls; and the bitmap of losses. Mostly nothing for
/// a while; who asks calm() first need not ask at() then.
/// Thread: its owner's, fit for rt.
class PathConditions {
 public:
  /// `start`: where the blackouts' times begin.
  PathConditions(const Impairment& law, const Streams& streams, TimePoint start) noexcept;
  /// From `at` on; what is going on goes on. `law` outlives this object or the next change.
  void change(const Impairment& law, TimePoint at) noexcept;

  /// at() would have nothing to say at `at`.
  [[nodiscard]] bool calm(TimePoint at) const noexcept { return at < calm_until_; }
  /// For datagram `index` that comes at `at`; neither falls from call to call.
  [[nodiscard]] PathCondition at(TimePoint at, std::uint64_t index) noexcept;

 private:
  [[nodiscard]] bool in_blackout(TimePoint at) const noexcept;
  [[nodiscard]] TimePoint next_trouble(TimePoint at) const noexcept;

  const Impairment* law_;
  TimePoint start_;
  TimePoint calm_until_{TimePoint::min()};
  BurstProcess burst_;
  GilbertTimeProcess gilbert_;
  StallProcess stall_;
};

}  // namespace palp::netem
