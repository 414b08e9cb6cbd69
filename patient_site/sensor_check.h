#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/core/result.h"
#include "common/core/time.h"
#include "site_program/dialogue.h"

namespace palp::patient {

/// What a sensor feels, whatever it is.
struct SensorFeeling {
  bool ready{};
  std::string trouble;     ///< of a fault
  std::uint64_t number{};  ///< of readings
  double force{};          ///< [N], tared
  double zero{};           ///< [N]
  bool saturated{};
};

/// What the check found.
struct SensorFound {
  double scale{1};  ///< [-], by which its unit is false; below 0: compression counts negative
  double noise{};   ///< [N], rms, in quiet air
  double zero{};    ///< [N], unloaded, before `scale`
  double rate{};    ///< [1/s], of readings
};

/// A guided check of a force sensor: tare, noise and rate in quiet air, then direction and scale
/// with a known weight, then that it comes back to 0. `step` waits for one of its periods and
/// reads. An error: what is wrong with it, or nobody answered. Thread: main. Blocks.
[[nodiscard]] Result<SensorFound> check_sensor(const std::function<SensorFeeling()>& step,
                                               const Clock& clock,
                                               site_program::Dialogue& talk);

}  // namespace palp::patient
