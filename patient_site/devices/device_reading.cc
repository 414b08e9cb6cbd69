#include "patient_site/devices/device_reading.h"

#include "common/io/device/register_port.h"

namespace palp::patient {

std::string_view to_string(DeviceState state) noexcept {
  switch (state) {
    case DeviceState::Absent:
      return "absent";
    case DeviceState::Starting:
      return "starting";
    case DeviceState::Ready:
      return "ready";
    case DeviceState::Fault:
      return "fault";
  }
  return "?";
}

std::string describe_reason(const DeviceReading& reading, const DeviceProfile& profile) {
  const std::size_t index = reading.detail;
  switch (reading.reason) {
    case DeviceReason::None:
      return "";
    case DeviceReason::Port:
      return std::string{io::to_string(static_cast<io::PortFault>(reading.detail))};
    case DeviceReason::NotHealthy:
      return "the device reports: " +
             (index < profile.healthy.size() ? profile.healthy[index].means : std::string{"?"});
    case DeviceReason::StartFailed:
      return "its start failed at: " +
             (index < profile.start.size() ? profile.start[index].means : std::string{"?"});
    case DeviceReason::MayNotMove:
      return "it must move, which may_home does not permit: " +
             (index < profile.start.size() ? profile.start[index].means : std::string{"?"});
    case DeviceReason::MovesWhenAsked:
      return "it must move, which begins with a reset: " +
             (index < profile.start.size() ? profile.start[index].means : std::string{"?"});
    case DeviceReason::CameBackOther:
      return "it came back by itself, which a reset must confirm: " +
             (index < profile.start.size() && profile.start[index].unasked
                  ? profile.start[index].unasked->means
                  : std::string{"?"});
    case DeviceReason::StandsElsewhere:
      return "it came back elsewhere than it stood: is its zero still good?";
    case DeviceReason::NoLife:
      return "it answers, but its sign of life stands still";
    case DeviceReason::NotFinite:
      return "a reading is no number";
    case DeviceReason::Stuck:
      return "the reading is stuck";
    case DeviceReason::Jumped:
      return "the position jumped";
    case DeviceReason::Touched:
      return "the tare was refused: something touches the sensor";
    case DeviceReason::Overloaded:
      return "the reading is at the end of its range";
    case DeviceReason::OutOfReach:
      return "its position is far outside its travel: are unit and word order the device's?";
    case DeviceReason::NotWhereSent:
      return "it does not go where it is sent";
  }
  return "?";
}

}  // namespace palp::patient
