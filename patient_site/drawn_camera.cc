#include "patient_site/drawn_camera.h"

namespace palp::patient {

video::Shot DrawnCamera::shoot(TimePoint /*now*/) {
  const video::TipSeen& tip = tip_.get();
  if (tip.at == drawn_at_) return {};
  drawn_at_ = tip.at;
  return {.picture = &picture_.draw({.x = tip.x, .depth = tip.depth, .surface = surface_}),
          .captured_at = tip.at};
}

}  // namespace palp::patient
