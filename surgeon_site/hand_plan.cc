#include "surgeon_site/hand_plan.h"

#include <algorithm>
#include <utility>

#include "surgeon_site/script_source.h"
#include "surgeon_site/settings_devices.h"

namespace palp::surgeon {

Result<HandPlan> plan_hand(const Settings& settings) {
  HandPlan hand;
  if (settings.master == kPointerMaster) {
    hand.facts = facts_of(settings.hand);
    return hand;
  }
  const KnownMaster* const product = master_named(settings.master);
  if (product == nullptr) {
    auto script = load_script(settings.master, {settings.hand.plant.grip.stiffness, {}});
    if (!script) return tl::unexpected{script.error()};
    hand.script = std::move(*script);
    hand.facts = facts_of(settings.hand);
    return hand;
  }
  if (settings.devices.empty()) {
    return fail("master '" + settings.master + "' needs --devices FILE");
  }
  auto plan = read_master_plan(*product, settings.devices);
  if (!plan) return tl::unexpected{plan.error()};
  hand.facts = plan->facts;
  hand.master = std::move(*plan);
  return hand;
}

std::unique_ptr<SimulatedHand> make_scripted(const SimulatedHandConfig& hand,
                                             std::optional<GestureScript> script) {
  return script ? std::make_unique<SimulatedHand>(hand, std::move(*script)) : nullptr;
}

std::unique_ptr<PointerHand> make_pointer(const Settings& settings) {
  if (settings.master != kPointerMaster) return nullptr;
  const SimulatedHandConfig& hand = settings.hand;
  return std::make_unique<PointerHand>(
      PointerHandConfig{.plant = hand.plant,
                        .encoder_step = hand.encoder_step,
                        .velocity_cut_off = hand.velocity_cut_off,
                        .force_max = hand.force_max,
                        .force_continuous = hand.force_continuous});
}

std::unique_ptr<MasterRig> start_master(const std::optional<MasterPlan>& plan, int priority) {
  return plan ? std::make_unique<MasterRig>(*plan, std::max(0, priority - 1)) : nullptr;
}

}  // namespace palp::surgeon
