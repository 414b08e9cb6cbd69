#include "surgeon_site/devices/paddle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "surgeon_site/devices/firmware/paddle/paddle_report.h"

namespace palp::surgeon {
namespace {

constexpr std::uint16_t kPaddleValidMs = 20;  // [ms], after the last word of a host that died

std::string_view paddle_trouble(std::uint16_t flags) noexcept {
  if ((flags & palp_paddle::kStateEmergencyStop) != 0) return "emergency stop";
  if ((flags & palp_paddle::kStateTooHot) != 0) return "the motor is too hot";
  if ((flags & palp_paddle::kStateCalibrated) == 0) return "its firmware is not calibrated";
  return {};
}

}  // namespace

io::HidAddress Paddle::address() {
  // Interface 1 is a serial port that looks alike.
  return {.vendor = palp_paddle::kVendor,
          .product = palp_paddle::kProduct,
          .interface_number = -1,
          .usage_page = palp_paddle::kUsagePage,
          .serial = {}};
}

StartOutcome Paddle::start(io::ReportPort& /*port*/, TimePoint /*now*/, std::string_view& /*why*/) {
  return StartOutcome::Done;
}

Taken Paddle::take(std::span<const std::uint8_t> report, TimePoint /*now*/, MasterSample& sample) {
  palp_paddle::State state{};
  if (!palp_paddle::unpack(report.data(), report.size(), state)) return Taken::Unknown;
  sample.position = state.position_nm;
  sample.velocity = state.velocity_um_per_s * 1e3;
  sample.velocity_known = true;
  sample.pedal_held = (state.flags & palp_paddle::kStatePedalHeld) != 0;
  sample.emergency_stop = (state.flags & palp_paddle::kStateEmergencyStop) != 0;
  sample.trouble = paddle_trouble(state.flags);
  sample.sequence = state.sequence;
  sample.sequence_known = true;
  return Taken::Reading;
}

io::PortFault Paddle::send(io::ReportPort& port, double force, bool live, TimePoint now) {
  constexpr double kMost = 2e9;  // [uN], within 32 bits
  palp_paddle::Command command{};
  command.sequence = ++sequence_;
  command.flags = static_cast<std::uint16_t>((live ? palp_paddle::kCommandEnable : 0U) |
                                             (engaged_ ? palp_paddle::kCommandLamp : 0U));
  command.time_us = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(now.time_since_epoch()).count());
  command.force_un = static_cast<std::int32_t>(std::lround(std::clamp(force, -kMost, kMost)));
  command.valid_for_ms = live ? kPaddleValidMs : std::uint16_t{0};
  std::array<std::uint8_t, 1 + palp_paddle::kReportBytes> report{};  // the first byte: no id
  palp_paddle::pack(command, report.data() + 1);
  return port.write(report);
}

void Paddle::stop(io::ReportPort& port) {
  engaged_ = false;
  (void)send(port, 0, false, TimePoint{});
}

}  // namespace palp::surgeon
