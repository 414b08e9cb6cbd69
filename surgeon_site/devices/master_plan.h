#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/device_facts.h"
#include "common/io/device/modbus_port.h"
#include "common/io/device/report_port.h"
#include "surgeon_site/devices/answer_buttons.h"
#include "surgeon_site/devices/master_device.h"
#include "surgeon_site/devices/shaft_motor.h"
#include "surgeon_site/devices/space_mouse.h"

namespace palp::surgeon {

/// Of the masters that are known.
enum class MasterKind : std::uint8_t { Board, Paddle, SpaceMouse, ShaftMotor };
struct KnownMaster {
  MasterKind kind{};
  std::string_view flag;  ///< as --master names it
  std::string_view name;  ///< for people
  bool force{};           ///< has a motor
};
[[nodiscard]] const std::vector<KnownMaster>& known_masters();
/// nullptr: none of that name, as where it is a script.
[[nodiscard]] const KnownMaster* master_named(std::string_view flag) noexcept;
/// All that this product may call itself on USB; none: it is no device on USB.
[[nodiscard]] std::vector<io::HidAddress> addresses_of(MasterKind kind);

/// One master, ready to be made.
struct MasterPlan {
  const KnownMaster* product{};  ///< of known_masters()
  MasterInstallation installation;
  HandFacts facts;
  SpaceMouse::Rates rates;  ///< of one that has no force
  int pedal_button{};
  AnswerButtons answer_buttons;
  std::string serial;      ///< empty: whichever is there
  io::ModbusAddress line;  ///< of one that is no device on USB
  io::HidAddress pedal;    ///< of one without buttons; some device's
  ShaftMotor::Pedal pedal_bit;
};

[[nodiscard]] std::unique_ptr<MasterProtocol> make_protocol(const MasterPlan& plan);
/// Where one of a product's models is there, that one; else any, which then is told to be absent.
/// Blocks.
[[nodiscard]] std::unique_ptr<io::ReportPort> make_port(const MasterPlan& plan);

}  // namespace palp::surgeon
