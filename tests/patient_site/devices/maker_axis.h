#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "patient_site/devices/register_device.h"
#include "patient_site/settings_devices.h"
#include "tests/common/io/device/fake_registers.h"

namespace palp::patient {

/// An axis of the maker whose name stands there, in virtual time: it goes where it is sent.
class MakerAxis {
 public:
  explicit MakerAxis(const std::string& name = "iai", DeviceInstallation built_in = installation())
      : MakerAxis(find_profile(name).value(), built_in) {
    if (name == "iai") {
      port.words[0x9005] = 0x3010;
      port.written = [this](std::uint16_t address) {
        if (address != 0x9900) return;
        port.words[0x9000] = port.words[0x9900];
        port.words[0x9001] = port.words[0x9901];
      };
    }
    if (name == "orca") {
      port.written = [this](std::uint16_t address) {
        if (address != 30) return;
        port.words[342] = port.words[30];
        port.words[343] = port.words[31];
      };
    }
  }
  MakerAxis(const DeviceProfile& profile, const DeviceInstallation& built_in)
      : profile_{profile}, device_{profile_, built_in, port} {}
  static DeviceInstallation installation() {
    DeviceInstallation built_in;
    built_in.zero = 0.05;
    built_in.reversed = true;
    built_in.speed_max = 0.1;
    built_in.acceleration_max = 2;
    built_in.tare_time = std::chrono::milliseconds{100};
    return built_in;
  }
  const DeviceReading& cycles(int count) {
    for (int i = 0; i < count; ++i) {
      clock.at += profile_.period;
      if (alive) command.valid_until = clock.at + std::chrono::milliseconds{50};
      const double before = reading.position;
      const bool was_ready = reading.state == DeviceState::Ready;
      reading = device_.cycle(clock, command);
      if (was_ready && reading.state == DeviceState::Ready) {
        fastest = std::max(fastest, std::abs(reading.position - before) / seconds(profile_.period));
      }
    }
    return reading;
  }
  void move(double target) {
    command.move = true;
    command.target = target;
  }
  [[nodiscard]] std::string why() const { return describe_reason(reading, profile_); }

  FakeRegisters port;
  TestClock clock;
  DeviceCommand command;
  DeviceReading reading;
  double fastest{};  ///< [m/s]
  bool alive{true};  ///< of the one who commands

 private:
  DeviceProfile profile_;
  RegisterDevice device_;
};

}  // namespace palp::patient
