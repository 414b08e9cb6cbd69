#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/result.h"
#include "common/io/device/report_port.h"
#include "site_program/dialogue.h"
#include "surgeon_site/devices/master_plan.h"

namespace palp::surgeon {

/// A guided check of a haptic master: at rest, direction and scale against a ruler, the site's 0,
/// limits, and, where it has a motor, its direction, its latency and its force against a scale. No
/// more than 30 % of its force is asked for, each time after a "yes". Thread: main. Blocks.
class MasterCheck {
 public:
  /// `pass` waits for so long. All outlive it.
  MasterCheck(MasterPlan plan,
              io::ReportPort& port,
              const Clock& clock,
              std::function<void(Duration)> pass,
              site_program::Dialogue& talk);
  /// The plan as it was found to be; an error: what is wrong with the device, or nobody answered.
  [[nodiscard]] Result<MasterPlan> run();

 private:
  using Flaw = std::optional<std::string>;
  /// What was seen for some time.
  struct Seen {
    double place{};   ///< [m], mean
    double spread{};  ///< [m], from the least to the most
    double rate{};    ///< [1/s], of reports
  };

  [[nodiscard]] Flaw begin();
  [[nodiscard]] Flaw watch(Duration span, Seen& seen);
  [[nodiscard]] MasterReading step(double force);
  [[nodiscard]] Flaw look_at_rest();
  [[nodiscard]] Flaw measure_scale();
  [[nodiscard]] Flaw set_zero();
  [[nodiscard]] Flaw find_limits();
  [[nodiscard]] Flaw push();
  [[nodiscard]] Flaw push_once(double force, double& moved, Duration& after);
  [[nodiscard]] Flaw weigh();

  MasterPlan plan_;
  io::ReportPort& port_;
  const Clock& clock_;
  std::function<void(Duration)> pass_;
  site_program::Dialogue& talk_;
  std::unique_ptr<MasterDevice> device_;
  double noise_{};       ///< [m], at rest, from the least to the most
  bool limits_found_{};  ///< by this check
};

}  // namespace palp::surgeon
