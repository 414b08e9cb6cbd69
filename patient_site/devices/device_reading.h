#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/time.h"
#include "patient_site/devices/device_profile.h"
#include "patient_site/devices/load_check.h"

namespace palp::patient {

enum class DeviceState : std::uint8_t {
  Absent,    ///< cannot be reached; tried again now and then
  Starting,  ///< steps of its start, tare
  Ready,
  Fault  ///< reached, and not fit: stays until restarted
};

enum class DeviceReason : std::uint8_t {
  None,
  Port,             ///< detail: io::PortFault
  NotHealthy,       ///< detail: index of the condition
  StartFailed,      ///< detail: index of the step
  MayNotMove,       ///< detail: index of the step that the installation forbids
  MovesWhenAsked,   ///< detail: index of the step; it came back by itself
  CameBackOther,    ///< the same, and what the step asks for then does not hold
  StandsElsewhere,  ///< than before its line was lost: its zero may be another
  NoLife,           ///< answers, and its life word stands still
  NotFinite,
  Stuck,
  Jumped,       ///< a position that no motion leads to
  Touched,      ///< the tare was refused
  Overloaded,   ///< its force is at the end of its range from the start on
  OutOfReach,   ///< far outside its travel: unit or word order are not the device's
  NotWhereSent  ///< stands, or moves, elsewhere
};

/// Newest state of a device, as it crosses threads.
struct DeviceReading {
  DeviceState state{};
  DeviceReason reason{};
  std::uint32_t detail{};    ///< by reason
  std::uint64_t number{};    ///< of good readings
  std::uint64_t failures{};  ///< transactions without a good answer
  std::uint32_t starts{};    ///< times it became ready
  TimePoint sampled_at{};    ///< middle of the transaction
  double position{};         ///< [m], of the site
  double velocity{};         ///< [m/s]
  double force{};            ///< [N], tared
  double zero{};             ///< [N], the tare
  TareNews tare;
  bool saturated{};
  bool at_limit{};
};

/// What is asked of a device: by a person, each counts up, and by the site.
struct DeviceAsks {
  std::uint32_t restarts{};  ///< out of a fault, from the beginning
  std::uint32_t tares{};     ///< a new tare
  bool may_touch{};          ///< the tip may: no tare, and none goes on
};

/// What an axis shall do, and until when.
struct DeviceCommand {
  bool move{};      ///< towards `target`; else hold
  double target{};  ///< [m], of the site
  TimePoint valid_until{};
  DeviceAsks asks;
};

/// "not healthy: emergency stop". Allocates.
[[nodiscard]] std::string describe_reason(const DeviceReading& reading,
                                          const DeviceProfile& profile);
[[nodiscard]] std::string_view to_string(DeviceState state) noexcept;

}  // namespace palp::patient
