#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "common/core/jump_allowance.h"
#include "common/core/time.h"
#include "common/io/device/report_port.h"
#include "surgeon_site/devices/master_protocol.h"

namespace palp::surgeon {

enum class MasterState : std::uint8_t {
  Absent,    ///< cannot be reached; tried again now and then
  Starting,  ///< steps of its start
  Ready,
  Fault  ///< reached, and not fit: stays until restarted
};
[[nodiscard]] std::string_view to_string(MasterState state) noexcept;

/// How a master is built in. Without a unit of force it gives none.
struct MasterInstallation {
  double position_unit{};     ///< [m] per count, above 0
  double force_unit{};        ///< [N] per count; 0: not calibrated
  double zero{};              ///< [m], its reading at the site's 0
  bool reversed{};            ///< counts against the site
  bool force_reversed{};      ///< a positive count pulls the hand in
  double travel_min{-60e-3};  ///< [m], of the site; beyond it a reading is a fault
  double travel_max{20e-3};   ///< [m]
  double speed_max{3};        ///< [m/s]; faster, no hand is
  double force_max{};         ///< [N]
  Duration silence{};         ///< longer is a fault; 0: never
  double velocity_pole{60};   ///< [Hz], of velocities that are taken from positions
  Duration period{std::chrono::milliseconds{1}};  ///< between two looks
};

/// Newest state of a master, as it crosses threads.
struct MasterReading {
  MasterState state{};
  std::string_view why;     ///< of Absent and Fault; lives for ever
  std::uint64_t number{};   ///< of good reports
  std::uint64_t skipped{};  ///< good, and older than another of the same cycle
  std::uint64_t lost{};     ///< by the device's own sequence
  std::uint64_t broken{};   ///< no reports of this product
  std::uint64_t unsent{};   ///< commands that could not be written
  std::uint32_t starts{};   ///< times it became ready
  TimePoint sampled_at{};   ///< of the newest report
  TimePoint looked_at{};    ///< no newer one was there then
  double position{};        ///< [m], of the site
  double velocity{};        ///< [m/s]
  Place place{};
  double force{};  ///< [N], sent
  bool pedal_held{};
  bool emergency_stop{};
  std::uint32_t answers{};  ///< times that a button of an answer was pressed
  std::uint32_t answer{};   ///< the last of them, from 1
};

struct MasterCommand {
  double force{};  ///< [N], + pushes the hand out
  bool engaged{};  ///< for a lamp
  TimePoint valid_until{};
  std::uint32_t restarts{};  ///< counts up: out of a fault, from the beginning
};

/// One haptic master, from absent to ready and to its faults. An old command, one that is no
/// number, and each fault mean no force. Told the time. Thread: its device's. The port outlives it.
class MasterDevice {
 public:
  MasterDevice(std::unique_ptr<MasterProtocol> protocol,
               const MasterInstallation& installation,
               io::ReportPort& port);

  /// One period.
  MasterReading cycle(const Clock& clock, const MasterCommand& command);
  /// On the way out: no force, whatever was asked before.
  void stop();

 private:
  void reach(TimePoint now);
  void enter_start() noexcept;
  void drain(const Clock& clock);
  void adopt(TimePoint now);
  void hear_answers() noexcept;
  void derive_velocity(double way, double span) noexcept;
  void proceed(TimePoint now);
  void send(const MasterCommand& command, TimePoint now);
  void vanish(std::string_view why, TimePoint now);
  void fail(std::string_view why);

  std::unique_ptr<MasterProtocol> protocol_;
  MasterInstallation installation_;
  io::ReportPort& port_;
  MasterSample sample_;
  MasterReading now_;
  TimePoint heard_at_{};    ///< last good report, or the opening
  TimePoint reached_at_{};  ///< by a command, or the opening
  std::string_view held_;   ///< why of the fault that no person has reset yet
  TimePoint reopen_at_{};
  TimePoint stepped_at_{};  ///< of the velocity
  TimePoint started_at_{};  ///< end of the protocol's start
  JumpAllowance jumps_;
  std::uint8_t answers_held_{};  ///< as at the look before
  bool asked_{true};             ///< this start, by a person
  bool tried_{};
  bool start_done_{};
  bool position_known_{};  ///< since the start
  bool sequence_known_{};
  std::uint16_t sequence_{};
  std::uint32_t restarts_{};
};

}  // namespace palp::surgeon
