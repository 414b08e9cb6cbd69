#pragma once

#include <optional>

#include "common/core/device_facts.h"
#include "common/core/time.h"

namespace palp::patient {

struct ForceSample {
  TimePoint sampled_at{};
  double force{};  ///< [N], contact, compression positive; noise may make it slightly negative
  bool saturated{};
};

/// Thread: rt. Returns within 50 us and never blocks.
class ForceSensor {
 public:
  virtual ~ForceSensor() = default;
  /// What it is: the same for as long as it lives. Thread: any.
  [[nodiscard]] virtual ForceSensorFacts sensor_facts() const noexcept = 0;
  virtual std::optional<ForceSample> sample(TimePoint now) noexcept = 0;  ///< nullopt: none new
  /// Once a tick: whether the tip may touch something from here on. A sensor whose zero is being
  /// taken keeps its old one then.
  virtual void expect_touch(bool /*may_touch*/) noexcept {}
};

}  // namespace palp::patient
