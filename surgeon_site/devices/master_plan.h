#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/device_facts.h"
#include "common/io/device/report_port.h"
#include "surgeon_site/devices/master_device.h"
#include "surgeon_site/devices/space_mouse.h"

namespace palp::surgeon {

/// Of the masters that are known.
enum class MasterKind : std::uint8_t { Board, Paddle, SpaceMouse };
struct KnownMaster {
  MasterKind kind{};
  std::string_view flag;  ///< as --master names it
  std::string_view name;  ///< for people
  bool force{};           ///< has a motor
};
[[nodiscard]] const std::vector<KnownMaster>& known_masters();
/// nullptr: none of that name, as where it is a script.
[[nodiscard]] const KnownMaster* master_named(std::string_view flag) noexcept;
/// All that this product may call itself.
[[nodiscard]] std::vector<io::HidAddress> addresses_of(MasterKind kind);

/// One master, ready to be made.
struct MasterPlan {
  const KnownMaster* product{};  ///< of known_masters()
  MasterInstallation installation;
  HandFacts facts;
  SpaceMouse::Rates rates;  ///< of one that has no force
  int pedal_button{};
  std::string serial;  ///< empty: whichever is there
};

[[nodiscard]] std::unique_ptr<MasterProtocol> make_protocol(const MasterPlan& plan);

}  // namespace palp::surgeon
