#include "patient_site/drawn_camera.h"

namespace palp::patient {

video::Shot DrawnCamera::shoot(TimePoint /*now*/) {
  const video::TipSeen& tip = tip_.get();
  if (tip.at == drawn_at_) return {};
  drawn_at_ = tip.at;
  return {.picture = &picture_.draw({.x = tip.x, .depth = tip.depth, .surface = surface_}),
          .captured_at = tip.at};
}

std::unique_ptr<video::Camera> make_camera(std::unique_ptr<video::Camera> captured,
                                           std::string_view source,
                                           Mailbox<video::TipSeen>* tip,
                                           double surface) {
  if (captured) return captured;
  if (source == "phantom") return std::make_unique<DrawnCamera>(*tip, surface);
  if (source == "test") return std::make_unique<video::TestCamera>();
  return nullptr;
}

}  // namespace palp::patient
