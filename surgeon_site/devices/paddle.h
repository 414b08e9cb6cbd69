#pragma once

#include "surgeon_site/devices/master_protocol.h"

namespace palp::surgeon {

/// A paddle with the firmware of firmware/paddle. Its counts are nm and uN, its start is nothing
/// but its first good report. Thread: its device's.
class Paddle final : public MasterProtocol {
 public:
  static constexpr double kPositionUnit = 1e-9;  ///< [m]
  static constexpr double kForceUnit = 1e-6;     ///< [N]
  [[nodiscard]] static io::HidAddress address();

  void begin(bool /*asked*/) noexcept override {}
  StartOutcome start(io::ReportPort& port, TimePoint now, std::string_view& why) override;
  Taken take(std::span<const std::uint8_t> report, TimePoint now, MasterSample& sample) override;
  io::PortFault send(io::ReportPort& port, double force, bool live, TimePoint now) override;
  void show_lamp(bool engaged) noexcept override { engaged_ = engaged; }
  void stop(io::ReportPort& port) override;

 private:
  std::uint16_t sequence_{};
  bool engaged_{};
};

}  // namespace palp::surgeon
