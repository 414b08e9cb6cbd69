#include "surgeon_site/settings.h"

#include "common/config/document.h"
#include "common/core/formatted.h"
#include "common/settings/units.h"
#include "proto/config.pb.h"

namespace palp::surgeon {
namespace {

using settings::from_micro;
using settings::from_milli;

Result<SimulatedHandConfig> make_hand(const proto::config::Hand& message) {
  const Result<Grip> grip = grip_named(message.grip());
  if (!grip) return fail(grip.error().text);
  SimulatedHandConfig hand;
  hand.plant.grip = *grip;
  hand.plant.mass = message.mass_kg();
  hand.plant.damping = message.damping_n_s_per_m();
  hand.plant.friction = message.friction_n();
  hand.plant.reaction.reflex = message.reflex();
  hand.plant.reaction.reflex_delay = settings::from_milliseconds(message.reflex_delay_ms());
  hand.plant.reaction.co_contraction = message.co_contraction_per_n();
  if (const double most = reflex_borne(hand.plant); message.reflex() > most) {
    return fail(
        formatted("hand.reflex %g is too much: grip '%s' on a device of %g kg may swing by "
                  "itself beyond %.3f",
                  message.reflex(),
                  message.grip().c_str(),
                  message.mass_kg(),
                  most));
  }
  hand.person.surface_offset = from_milli(message.surface_offset_mm());
  hand.person.engage_again = message.engage_again();
  hand.tremor = from_milli(message.tremor_mm());
  hand.tremor_frequency = message.tremor_hz();
  hand.encoder_step = from_micro(message.encoder_um());
  hand.force_max = message.force_max_n();
  hand.force_continuous = message.force_continuous_n();
  return hand;
}

ForceGateConfig make_gate(const proto::config::ForceGate& message) {
  ForceGateConfig gate;
  gate.force_max = message.force_max_n();
  gate.force_continuous = message.force_continuous_n();
  gate.fade_slew = gate.growth.slew = message.fade_slew_n_per_s();
  gate.thermal_time = message.thermal_s();
  return gate;
}

}  // namespace

Result<Settings> make_settings(const proto::config::SurgeonConfig& message) {
  const auto coupling = settings::make_coupling(message.coupling());
  if (!coupling) return fail(coupling.error().text);
  const auto hand = make_hand(message.hand());
  if (!hand) return fail(hand.error().text);
  const auto record = settings::make_record(message.record());
  if (!record) return fail(record.error().text);
  Settings made;
  made.peer = message.peer();
  made.protection = settings::make_protection(message.link());
  made.coupling = *coupling;
  made.loop = settings::make_loop(message.loop());
  made.agreement = settings::agreement_hash(message.coupling(), made.loop.period);
  made.link = settings::make_link(message.link(), made.loop.period);
  made.node.period = made.loop.period;
  made.direct_round_trip_max =
      settings::from_milliseconds(message.engagement().direct_round_trip_max_ms());
  made.engagement_forced = message.engagement().forced();
  if (coupling->name == "direct" && !made.engagement_forced) {
    made.node.supervisor.round_trip_max_to_engage = made.direct_round_trip_max;
  }
  made.node.gate = make_gate(message.force_gate());
  made.node.hold_in_plane = message.hand().hold_in_plane();
  made.master = message.hand().master();
  made.devices = message.devices();
  made.grip = message.hand().grip();
  made.hand = *hand;
  made.impairment = settings::make_impairment(message.impairment());
  made.record = *record;
  made.monitor = settings::make_monitor(message.monitor());
  made.picture_in_step = message.picture_in_step();
  if (made.picture_in_step && coupling->name != "wave" && coupling->name != "tdpa") {
    return fail("picture_in_step makes touch as old as the picture, which coupling '" +
                coupling->name + "' does not bear: take wave or tdpa");
  }
  made.duration = from_seconds(message.duration_s());
  made.give_up_after = from_seconds(message.give_up_after_s());
  made.seed = message.seed();
  return made;
}

Result<Settings> make_settings(const config::Document& document) {
  return make_settings(document.as<proto::config::SurgeonConfig>());
}

}  // namespace palp::surgeon
