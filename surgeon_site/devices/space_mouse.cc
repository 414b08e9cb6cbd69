#include "surgeon_site/devices/space_mouse.h"

#include <algorithm>
#include <cmath>

namespace palp::surgeon {
namespace {

constexpr double kFullDeflection = 350;  // [counts]
constexpr double kDeadZone = 0.08;       // [-], of it: hands rest on the cap
constexpr Duration kCapSilence = std::chrono::milliseconds{100};
constexpr Duration kCapStepMax = std::chrono::milliseconds{20};  // a pause is not made up for

double deflection_at(std::span<const std::uint8_t> report, std::size_t at) noexcept {
  const auto counts =
      static_cast<std::int16_t>(static_cast<std::uint16_t>(report[at] | (report[at + 1] << 8U)));
  const double part = std::clamp(counts / kFullDeflection, -1.0, 1.0);
  if (std::abs(part) < kDeadZone) return 0;
  return std::copysign((std::abs(part) - kDeadZone) / (1 - kDeadZone), part);
}

}  // namespace

std::array<io::HidAddress, 8> SpaceMouse::addresses() {
  constexpr std::uint16_t kNew = 0x256F;
  constexpr std::uint16_t kOld = 0x046D;
  const auto model = [](std::uint16_t vendor, std::uint16_t product) {
    return io::HidAddress{.vendor = vendor,
                          .product = product,
                          .interface_number = -1,
                          .usage_page = 1,
                          .serial = {}};
  };
  return {model(kNew, 0xC635),
          model(kNew, 0xC62E),
          model(kNew, 0xC62F),
          model(kNew, 0xC631),
          model(kNew, 0xC632),
          model(kNew, 0xC633),
          model(kOld, 0xC626),
          model(kOld, 0xC62B)};
}

void SpaceMouse::begin(bool /*asked*/) noexcept {
  deflection_ = {};
  position_ = rates_.begin;
  place_ = {};
  pedal_held_ = stepped_ = false;
  answers_held_ = 0;
}

StartOutcome SpaceMouse::start(io::ReportPort& /*port*/,
                               TimePoint /*now*/,
                               std::string_view& /*why*/) {
  return StartOutcome::Done;
}

Taken SpaceMouse::take(std::span<const std::uint8_t> report,
                       TimePoint now,
                       MasterSample& /*sample*/) {
  // Newer models send all six axes in one report of 13 bytes.
  if (report.empty()) return Taken::Unknown;
  if (report[0] == 1 && (report.size() == 7 || report.size() == 13)) {
    for (std::size_t i = 0; i < deflection_.size(); ++i) {
      deflection_[i] = deflection_at(report, 1 + 2 * i);
    }
    heard_at_ = now;
    return Taken::Reading;
  }
  if (report[0] == 2 && report.size() == 7)
    return Taken::Reading;  // turns, which mean nothing here
  if (report[0] != 3 || report.size() < 3) return Taken::Unknown;
  const unsigned buttons = report[1] | (static_cast<unsigned>(report[2]) << 8U);
  pedal_held_ = ((buttons >> static_cast<unsigned>(rates_.pedal_button)) & 1U) != 0;
  answers_held_ = answers_.held(report.subspan(1, 2));
  return Taken::Reading;
}

bool SpaceMouse::advance(TimePoint now, MasterSample& sample) {
  const Duration passed = stepped_ ? std::min(now - stepped_at_, kCapStepMax) : Duration{0};
  stepped_ = true;
  stepped_at_ = now;
  if (now - heard_at_ > kCapSilence) deflection_ = {};
  const double span = seconds(passed);
  const double speed = deflection_[2] * rates_.speed_max;  // the cap's z points down
  const auto side = [&](double from, double part) {
    return std::clamp(from + part * rates_.side_speed_max * span, -rates_.reach, rates_.reach);
  };
  position_ = std::clamp(position_ + speed * span, rates_.travel_min, rates_.travel_max);
  place_ = {side(place_.x, deflection_[0]), side(place_.y, -deflection_[1])};
  sample.position = position_;
  sample.place = place_;
  sample.velocity = speed;
  sample.velocity_known = true;
  sample.pedal_held = pedal_held_;
  sample.answers_held = answers_held_;
  return true;
}

io::PortFault SpaceMouse::send(io::ReportPort& /*port*/,
                               double /*force*/,
                               bool /*live*/,
                               TimePoint /*now*/) {
  return io::PortFault::None;
}

}  // namespace palp::surgeon
