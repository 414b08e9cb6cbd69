#include "surgeon_site/surgeon_node.h"

#include <utility>

namespace palp::surgeon {

SurgeonNode::SurgeonNode(const SurgeonConfig& config, Parts parts)
    : parts_{parts}, control_{config, parts.device.hand_facts(), {parts.law, parts.recorder}} {}

SurgeonInputs SurgeonNode::read(TimePoint now) noexcept {
  SurgeonInputs in;
  in.now = now;
  in.hand = parts_.device.read(now);
  in.script = parts_.device.progress();
  in.user = commands_.get();
  const std::uint32_t obeyed = std::exchange(stopped_, stops_.get());
  if (stopped_ != obeyed) in.user.emergency_stop = true;
  in.arrived = parts_.link.receive(now);
  in.link = parts_.link.health(now);
  if (in.link.session_id != control_.status().link.session_id) {
    in.peer_devices = parts_.link.peer_devices();
    held_.forget();
  }
  in.arrived.samples = held_.pass(in.arrived.samples, touch_hold_.get(), now);
  return in;
}

void SurgeonNode::tick(TimePoint now) noexcept {
  const SurgeonInputs in = read(now);
  const std::uint32_t epoch = control_.status().epoch;
  const SurgeonOutputs out = control_.decide(in);
  parts_.device.apply(out.force);
  parts_.device.hold_in_plane(out.hold_in_plane);
  parts_.link.send(out.to_peer, now);
  control_.write_down(in, out);
  if (control_.status().epoch != epoch) held_.forget();
  parts_.device.show(out.view);
  status_.put(control_.status());
}

}  // namespace palp::surgeon
