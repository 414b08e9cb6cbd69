#include "patient_site/patient_node.h"

#include "patient_site/tare_rule.h"

namespace palp::patient {

PatientNode::PatientNode(const PatientConfig& config, Parts parts)
    : parts_{parts},
      control_{config,
               {parts.stage.stage_facts(), parts.sensor.sensor_facts()},
               {parts.law, parts.recorder, parts.contact}} {}

PatientInputs PatientNode::read(TimePoint now) noexcept {
  PatientInputs in;
  in.now = now;
  in.stage = parts_.stage.read(now);
  in.force = parts_.sensor.sample(now);
  in.user = commands_.get();
  in.arrived = parts_.link.receive(now);
  in.link = parts_.link.health(now);
  if (in.link.session_id != control_.status().link.session_id) {
    in.peer_devices = parts_.link.peer_devices();
  }
  in.found = parts_.found.get();
  in.map_cells = parts_.cells.get().told();
  return in;
}

void PatientNode::act(const PatientOutputs& out, TimePoint now) noexcept {
  if (out.halt) {
    parts_.stage.halt();
  } else {
    parts_.stage.move_to(out.target);
  }
  parts_.sensor.expect_touch(why_no_tare(control_.status()).has_value());
  parts_.link.send(out.to_peer, now);
}

void PatientNode::tick(TimePoint now) noexcept {
  const PatientInputs in = read(now);
  const PatientOutputs out = control_.decide(in);
  act(out, now);
  control_.write_down(in, out);
  status_.put(control_.status());
}

}  // namespace palp::patient
