#pragma once

#include <array>
#include <chrono>

#include "common/coupling/mmt.h"

namespace palp::coupling {

/// A tick of 1 ms without a path: a hand at `position` [m] to which `force` [N] was given hears
/// `model`. @returns the force that it is given next [N].
inline double told_hand(MmtSurgeon& law, const ModelPayload& model, double position, double force) {
  Incoming incoming;
  incoming.sample.payload = model;
  incoming.fresh = true;
  const std::array arrived{incoming};
  SurgeonInput in;
  in.state = SiteState::Engaged;
  in.position = position;
  in.force_applied = force;
  in.arrived = arrived;
  return law.step(in, std::chrono::milliseconds{1}).force;
}

}  // namespace palp::coupling
