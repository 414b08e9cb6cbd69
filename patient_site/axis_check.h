#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/result.h"
#include "patient_site/devices/device_plans.h"
#include "patient_site/devices/register_device.h"
#include "site_program/dialogue.h"

namespace palp::patient {

/// A guided check of an axis: how quickly it answers, how it moves by 2 mm and back, which way and
/// how far by a ruler, whether it stops when nobody commands it any more, and its limits. At
/// 10 mm/s, each motion after a "yes". Thread: main. Blocks.
class AxisCheck {
 public:
  /// `pass` waits for so long. All outlive it.
  AxisCheck(DevicePlan plan,
            io::RegisterPort& port,
            const Clock& clock,
            std::function<void(Duration)> pass,
            site_program::Dialogue& talk);
  /// The plan as it was found to be; an error: what is wrong with the device, or nobody answered.
  [[nodiscard]] Result<DevicePlan> run();

 private:
  using Flaw = std::optional<std::string>;

  [[nodiscard]] Flaw begin();
  /// One period; `commanded` false: nobody asks for anything.
  const DeviceReading& step(bool commanded, double target);
  [[nodiscard]] Flaw not_ready() const;
  [[nodiscard]] Flaw go(double target);
  [[nodiscard]] Flaw look_at_rest();
  [[nodiscard]] Flaw move_by_a_ruler();
  [[nodiscard]] Flaw leave_it_alone();
  [[nodiscard]] Flaw find_limits();
  [[nodiscard]] Flaw find_limit(double& limit, double inwards);

  DevicePlan plan_;
  io::RegisterPort& port_;
  const Clock& clock_;
  std::function<void(Duration)> pass_;
  site_program::Dialogue& talk_;
  std::unique_ptr<RegisterDevice> device_;
  DeviceReading now_;
  double noise_{};  ///< [m], at rest, from the least to the most
};

}  // namespace palp::patient
