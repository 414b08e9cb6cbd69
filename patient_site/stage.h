#pragma once

#include "common/core/device_facts.h"
#include "common/core/place.h"
#include "common/core/time.h"

namespace palp::patient {

struct StageState {
  TimePoint sampled_at{};
  double position{};  ///< [m], tip
  double velocity{};  ///< [m/s]
  Place place{};
  bool at_limit{};
  bool faulted{};
};

struct StageTarget {
  double position{};  ///< [m]
  Place place{};
};

/// Thread: rt. Each call returns within 50 us and never blocks.
class Stage {
 public:
  virtual ~Stage() = default;
  /// What it is: the same for as long as it lives. Thread: any.
  [[nodiscard]] virtual StageFacts stage_facts() const noexcept = 0;
  virtual StageState read(TimePoint now) noexcept = 0;
  virtual void move_to(const StageTarget& target) noexcept = 0;  ///< target of this tick
  virtual void halt() noexcept = 0;  ///< hold here, drop the target; idempotent
};

}  // namespace palp::patient
