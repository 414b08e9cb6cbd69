#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "patient_site/devices/register_device.h"
#include "patient_site/settings_devices.h"
#include "tests/common/io/device/fake_registers.h"

namespace palp::patient {

/// What one of the house's products does with its registers: an axis goes where it is sent, at its
/// own speed, until it is told to stop; a sensor feels `force`, with some noise. In virtual time,
/// one of our driver's cycles after the other.
class DriveModel {
 public:
  static constexpr double kSpeed = 0.1;  ///< [m/s], of the drive and of the installation

  explicit DriveModel(const std::string& name)
      : name_{name},
        profile_{find_profile(name).value()},
        device_{profile_, installation(), port},
        low_first_{name == "orca"} {
    if (name == "iai") port.words[0x9005] = 0x3010;
    port.written = [this](std::uint16_t address) { heed(address); };
    tell();
  }
  static DeviceInstallation installation() {
    DeviceInstallation built_in;
    built_in.zero = 0.05;
    built_in.speed_max = kSpeed;
    built_in.acceleration_max = 2;
    built_in.tare_time = std::chrono::milliseconds{100};
    built_in.stuck_after = std::chrono::milliseconds{300};
    return built_in;
  }
  /// Only the drive, not our driver.
  void pass(Duration span) {
    for (const TimePoint end = clock.at + span; clock.at < end;
         clock.at += std::chrono::milliseconds{1}) {
      advance();
    }
    ++noise_;
    tell();
  }
  /// So many of the driver's periods.
  const DeviceReading& cycles(int count) {
    for (int i = 0; i < count; ++i) {
      pass(profile_.period);
      if (alive) command.valid_until = clock.at + std::chrono::milliseconds{50};
      reading = device_.cycle(clock, command);
    }
    return reading;
  }
  void move(double target) {
    command.move = true;
    command.target = target;
  }
  [[nodiscard]] bool axis() const { return !profile_.move.empty(); }
  [[nodiscard]] const DeviceProfile& profile() const { return profile_; }
  [[nodiscard]] double place() const { return place_; }  ///< [m], where it really is
  [[nodiscard]] std::string why() const { return describe_reason(reading, profile_); }

  FakeRegisters port;
  TestClock clock;
  DeviceCommand command;
  DeviceReading reading;
  double force{};    ///< [N], on the sensor
  bool alive{true};  ///< of the one who commands
  bool swapped{};    ///< words of 32 bits, in both ways
  bool quiet{};      ///< without noise: stuck
  bool no_number{};
  double offset{};    ///< [m], what it reads too much
  double wobble{};    ///< [m], either way, of what it reads
  double stop_at{1};  ///< [m], it goes no further than that either way
  bool runs_on{};     ///< it goes on outwards, whatever it is told

 private:
  void heed(std::uint16_t address) {
    if (name_ == "iai" && address == 0x42C) stopped_ = port.coils[0x42C];
    if (name_ == "orca" && address == 3) stopped_ = port.words[3] != 3;
    if (name_ == "az" && address == 0x7C) stopped_ = port.words[0x7D] == 32;
    if (stopped_) target_ = place_;
    const int at = name_ == "iai" && address == 0x9900 ? 0x9900
                   : name_ == "orca" && address == 30  ? 30
                   : name_ == "az" && address == 0x58  ? 0x5C
                                                       : -1;
    if (at < 0 || stopped_) return;
    const auto first = static_cast<std::uint16_t>(at);
    const bool low = low_first_ != swapped;
    const std::uint32_t high = port.words[low ? first + 1 : first];
    const std::uint32_t lower = port.words[low ? first : first + 1];
    target_ = static_cast<std::int32_t>(high << 16U | lower) * unit() - 0.05;
  }
  void advance() {
    constexpr double kStep = kSpeed * 1e-3;
    if (runs_on) target_ = place_ - kStep / 10;
    place_ = std::clamp(place_ + std::clamp(target_ - place_, -kStep, kStep), -stop_at, stop_at);
    tell();
  }
  void tell() {
    const double felt = force + (quiet ? 0.0 : noise_ % 2 == 0 ? 2e-2 : -2e-2);
    if (name_ == "iai") put(0x9000, place_);
    if (name_ == "az") put(0xCC, place_);
    if (name_ == "orca") put(342, place_);
    if (name_ == "orca") put_bits(348, static_cast<std::uint32_t>(std::lround(felt * 1e3)));
    if (name_ == "tlb4") {
      put_bits(7, static_cast<std::uint32_t>(std::lround(std::abs(felt) * 1e2)));
      port.words[6] = felt < 0 ? 0x0080 : 0;
    }
    if (name_ == "z-sg") {
      put_bits(63, no_number ? 0x7FC00000 : std::bit_cast<std::uint32_t>(static_cast<float>(felt)));
    }
  }
  void put(std::uint16_t at, double place) {
    const double read = place + offset + wobble * (noise_ * 3 % 7 - 3) / 3;
    put_bits(at, static_cast<std::uint32_t>(std::lround((read + 0.05) / unit())));
  }
  void put_bits(std::uint16_t at, std::uint32_t bits) {
    const bool low = low_first_ != swapped;
    port.words[low ? at + 1 : at] = static_cast<std::uint16_t>(bits >> 16U);
    port.words[low ? at : at + 1] = static_cast<std::uint16_t>(bits & 0xFFFFU);
  }
  [[nodiscard]] double unit() const { return name_ == "orca" ? 1e-6 : 1e-5; }

  std::string name_;
  DeviceProfile profile_;
  RegisterDevice device_;
  bool low_first_;
  bool stopped_{true};
  double place_{};   ///< [m]
  double target_{};  ///< [m]
  int noise_{};
};

}  // namespace palp::patient
