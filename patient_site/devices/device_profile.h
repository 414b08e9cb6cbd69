#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/time.h"
#include "patient_site/servo_watch.h"

/// What a Modbus device is, as its register table says: registers, words, units, steps of its
/// start, conditions of its health. Plain data; a lab writes it as text.
namespace palp::patient {

enum class WordKind : std::uint8_t { U16, I16, U32, I32, F32 };
enum class WordOrder : std::uint8_t { HighFirst, LowFirst };  ///< of values of 32 bits

[[nodiscard]] constexpr std::size_t words_in(WordKind kind) noexcept {
  return kind == WordKind::U16 || kind == WordKind::I16 ? 1 : 2;
}

/// Where a value to write comes from.
enum class ValueSource : std::uint8_t { Constant, Position, Here, Speed, Acceleration, ForceLimit };

struct WriteValue {
  ValueSource source{};
  double number{};  ///< [counts], of a constant
  WordKind kind{WordKind::U16};
  double unit{};  ///< [m, m/s, m/s^2 or N per count]; 0: that of the position
};

enum class WriteKind : std::uint8_t { Registers, OneRegister, Coil };

/// One request that writes: function 16, 6 or 5.
struct RegisterWrite {
  WriteKind kind{};
  std::uint16_t address{};
  std::vector<WriteValue> values;  ///< of a coil: one, not 0 is on
};

/// (word at `address` & mask) == value.
struct RegisterCondition {
  std::uint16_t address{};
  std::uint16_t mask{0xffff};
  std::uint16_t value{};
  std::string means;  ///< what is wrong when it does not hold: "emergency stop"
};

/// A quantity in registers.
struct RegisterField {
  std::uint16_t address{};
  WordKind kind{WordKind::I32};
  double unit{1};                               ///< [m, N, m/s or m/s^2 per count]
  std::optional<RegisterCondition> negative{};  ///< holds: the counts, which have no sign, are < 0
};

struct StartStep {
  std::string means;  ///< "servo on"
  RegisterWrite write;
  std::optional<RegisterCondition> unless;  ///< holds: nothing to do
  std::optional<RegisterCondition> until;   ///< waited for
  Duration wait_max{std::chrono::seconds{2}};
  bool moves{};  ///< homing: only where the installation permits it
  /// Of a device that comes back by itself: where it does not hold, the step waits for a person.
  std::optional<RegisterCondition> unasked{};
};

struct DeviceProfile {
  std::string name;
  WordOrder order{};
  std::uint32_t baud{115'200};
  char parity{'N'};
  Duration reply_delay{};  ///< the device's own, longest
  Duration period{std::chrono::milliseconds{10}};
  Duration silence{std::chrono::milliseconds{100}};  ///< longer is a fault

  std::uint16_t read_address{};   ///< of the one request that reads all
  std::uint16_t read_count{};     ///< [words], 1 to 125
  bool input_registers{};         ///< function 4, not 3
  std::uint16_t state_address{};  ///< of a second one, at each tenth reading
  std::uint16_t state_count{};    ///< [words], 0: there is none

  std::optional<RegisterField> position;
  std::optional<RegisterField> force;
  std::vector<RegisterCondition> healthy;
  std::optional<std::uint16_t> life;  ///< a word that changes while the device works
  Duration life_within{};
  Duration stuck_after{};  ///< no force stays the same for so long; 0: it may
  std::vector<StartStep> start;
  std::vector<RegisterWrite> move;  ///< to a target, in this order; empty: no axis
  std::optional<RegisterWrite> stop;
  bool exchange{};      ///< `move` and the reading in one request, function 23
  bool only_changes{};  ///< a repeated target would begin a new move
};

/// The same in one place: how it is built in here.
struct DeviceInstallation {
  double zero{};               ///< [m or N], what the device reads at the site's 0
  bool reversed{};             ///< its positive direction is the site's negative one
  double position_unit{};      ///< [m per count]; 0: the profile's
  double force_unit{};         ///< [N per count]; 0: the profile's
  bool force_reversed{};       ///< its positive force is the site's negative one
  double speed_max{0.1};       ///< [m/s], above 0
  double acceleration_max{1};  ///< [m/s^2], above 0
  double force_limit{20};      ///< [N], of the drive itself, where it can be told
  double travel_min{-0.1};     ///< [m], of the site
  double travel_max{0.1};      ///< [m]
  bool may_home{};             ///< the steps that move are done
  double force_range{49};      ///< [N], readings from 99 % of it on are saturated
  double force_zero{};         ///< [N], an unloaded sensor is this ...
  double tare_within{0.5};     ///< [N], ... but for so much, or something touches it
  double tare_noise{0.1};      ///< [N], rms; more than quiet air
  Duration tare_time{std::chrono::seconds{1}};
  Duration stuck_after{};  ///< the same force for so long; 0: never
  /// Its drive is stopped then. The site, which knows more, has stopped before.
  ServoWatchConfig servo{.error = 1.5e-3, .time = std::chrono::milliseconds{500}};
};

}  // namespace palp::patient
