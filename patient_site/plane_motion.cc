#include "patient_site/plane_motion.h"

#include <algorithm>
#include <cmath>

#include "common/core/limits.h"

namespace palp::patient {

using record::NoteCode;

AxisMotion step_axis(const AxisMotion& from,
                     double target,
                     const AxisLimits& limits,
                     double span) noexcept {
  const double ahead = target - from.command;
  const double exact = ahead / span;
  const double change_max = limits.acceleration * span;
  const bool small = std::abs(ahead) <= limits.step_free;
  const bool reachable =
      std::abs(exact) <= limits.speed && (small || std::abs(exact - from.velocity) <= change_max);
  if (reachable) return {target, exact};
  const double braking = std::sqrt(2 * limits.acceleration * std::abs(ahead));
  const double wanted = std::copysign(std::min(limits.speed, braking), ahead);
  const double velocity =
      std::clamp(step_towards(from.velocity, wanted, change_max), -limits.speed, limits.speed);
  return {from.command + velocity * span, velocity};
}

void PlaneMotion::begin(const Place& place) noexcept {
  x_ = {.command = place.x, .velocity = 0};
  y_ = {.command = place.y, .velocity = 0};
}

NoteCode PlaneMotion::follow(const Place& asked, bool in_contact, double span) noexcept {
  if (!is_finite(asked)) {
    hold();
    return NoteCode::NotFinite;
  }
  const Place place{std::clamp(asked.x, -config_.travel_x / 2, config_.travel_x / 2),
                    std::clamp(asked.y, -config_.travel_y / 2, config_.travel_y / 2)};
  const bool may_drag = config_.drag_speed > 0;
  if (in_contact && !may_drag) {
    hold();
    // A hand is never quite still: only what it means to be another place is refused.
    return distance(asked, command()) > kSamePlace ? NoteCode::DragRefused : NoteCode::None;
  }
  const Place ahead{place.x - x_.command, place.y - y_.command};
  const double far = std::hypot(ahead.x, ahead.y);
  const auto limits = [&](double ahead_on_axis) {
    // A drag keeps to the straight line: the tissue feels the speed along it, not that of an axis.
    const double share = far > 0 ? std::abs(ahead_on_axis) / far : 1;
    const double drag = std::min(config_.drag_speed * share, config_.speed_max);
    return AxisLimits{.speed = in_contact ? drag : config_.speed_max,
                      .acceleration = config_.acceleration_max,
                      .step_free = 0};
  };
  x_ = step_axis(x_, place.x, limits(ahead.x), span);
  y_ = step_axis(y_, place.y, limits(ahead.y), span);
  return place == asked ? NoteCode::None : NoteCode::PlaceBeyondTravel;
}

}  // namespace palp::patient
