#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/core/jump_allowance.h"
#include "common/core/time.h"
#include "common/io/device/register_port.h"
#include "patient_site/devices/device_profile.h"
#include "patient_site/devices/device_reading.h"
#include "patient_site/devices/load_check.h"
#include "patient_site/devices/register_words.h"
#include "patient_site/plane_motion.h"
#include "patient_site/servo_watch.h"

namespace palp::patient {

/// One Modbus device, an axis or a force sensor or both, from absent to ready and to its faults.
/// Moves at its own rate, speed and acceleration towards the newest target; from where it stands
/// whenever it begins, so that no gap ends in a jump. An old command, a halt and each fault stop
/// it. Told the time. Thread: its device's. The port outlives it.
class RegisterDevice {
 public:
  /// Profile and installation are sound: see flaw_of().
  RegisterDevice(DeviceProfile profile,
                 const DeviceInstallation& installation,
                 io::RegisterPort& port);

  /// One period: `clock` says when transactions begin and end.
  DeviceReading cycle(const Clock& clock, const DeviceCommand& command);
  /// On the way out: stands still, whatever was asked before.
  void stop();

  [[nodiscard]] const DeviceProfile& profile() const noexcept { return profile_; }

 private:
  /// What a line that comes back by itself has no say in.
  struct ByPerson {
    bool started{true};           ///< this start; so it may home
    double stood_at{};            ///< [m], when it was ready last
    DeviceReason held{};          ///< the fault that is not reset yet
    std::uint32_t held_detail{};  ///< by `held`
  };
  /// Of its place.
  struct Seen {
    JumpAllowance jumps;
    ServoWatch servo;  ///< to what was delivered
    bool known{};      ///< since the start
  };
  void reach(TimePoint now);
  void enter_start(TimePoint now) noexcept;
  [[nodiscard]] bool poll(const Clock& clock);
  void take_reading(TimePoint sampled_at);
  void take_position(TimePoint sampled_at);
  void take_force(TimePoint sampled_at);
  void judge(TimePoint now);
  void watch_motion() noexcept;
  [[nodiscard]] bool meets(const RegisterCondition& condition) const noexcept;
  [[nodiscard]] std::optional<std::uint32_t> unhealthy() const noexcept;
  void proceed(TimePoint now);
  void next_step(TimePoint now) noexcept;
  void begin_motion(TimePoint now) noexcept;
  void steer(const DeviceCommand& command, TimePoint now) noexcept;
  void send_move(TimePoint now);
  [[nodiscard]] io::PortFault send(const RegisterWrite& write);
  [[nodiscard]] std::size_t words_of(const RegisterWrite& write,
                                     std::span<std::uint16_t> words) const noexcept;
  [[nodiscard]] bool within_reach(double position) const noexcept;
  [[nodiscard]] double raw_position(double position) const noexcept;
  void note_transfer(io::PortFault fault, TimePoint now);
  void fail(DeviceReason reason, std::uint32_t detail);

  DeviceProfile profile_;
  DeviceInstallation installation_;
  io::RegisterPort& port_;
  ReadWords words_;
  ReadWords state_;  ///< of the second request
  std::uint64_t polls_{};
  LoadCheck load_;
  DeviceReading now_;
  TimePoint heard_at_{};  ///< last good answer
  TimePoint reopen_at_{};
  bool tried_{};
  std::uint32_t failed_in_a_row_{};
  std::size_t step_{};  ///< of the start
  bool step_sent_{};
  TimePoint step_began_{};
  DeviceAsks asks_;  ///< as heard last
  ByPerson by_person_;
  Seen seen_;
  AxisMotion motion_;     ///< commanded
  AxisMotion delivered_;  ///< the last of them that arrived
  TimePoint steered_at_{};
  std::array<std::uint16_t, 2> sent_{};  ///< last target, in words
  bool anything_sent_{};
  std::uint16_t life_{};
  TimePoint lived_at_{};
};

}  // namespace palp::patient
