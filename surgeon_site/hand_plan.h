#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "common/core/result.h"
#include "surgeon_site/devices/master_rig.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/pointer_hand.h"
#include "surgeon_site/settings.h"
#include "surgeon_site/simulated_hand.h"

/// Whose hand it is: a person's at a device or at a pointer, or a script's.
namespace palp::surgeon {

/// The master that lies on the monitor's page.
inline constexpr std::string_view kPointerMaster = "pointer";

struct HandPlan {
  std::optional<GestureScript> script;  ///< of a simulated hand
  std::optional<MasterPlan> master;     ///< of a real one; neither: a pointer
  HandFacts facts;
};

/// Reads the script or the file of devices that the settings name. The sentence says what is wrong.
[[nodiscard]] Result<HandPlan> plan_hand(const Settings& settings);

/// Null where the hand is a person's.
[[nodiscard]] std::unique_ptr<SimulatedHand> make_scripted(const SimulatedHandConfig& hand,
                                                           std::optional<GestureScript> script);

/// Null unless the hand is that of a pointer.
[[nodiscard]] std::unique_ptr<PointerHand> make_pointer(const Settings& settings);

/// Started, not ready; null where the hand is no device's. `priority`: of the rt thread.
[[nodiscard]] std::unique_ptr<MasterRig> start_master(const std::optional<MasterPlan>& plan,
                                                      int priority);

}  // namespace palp::surgeon
