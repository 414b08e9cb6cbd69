#include "surgeon_site/hand_plant.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "common/core/check.h"

namespace palp::surgeon {

Result<Grip> grip_named(std::string_view name) {
  if (name == "light") return kLightGrip;
  if (name == "mid") return kMidGrip;
  if (name == "firm") return kFirmGrip;
  if (name == "arm") return kArmGrip;
  std::string text = "unknown grip '" + std::string{name} + "'; there are:";
  for (const std::string_view known : kGripNames) text.append(" ").append(known);
  return fail(text);
}

double reflex_borne(const HandPlantConfig& config) noexcept {
  constexpr double kMargin = 0.75;  // [-]
  constexpr int kParts = 200;
  const Grip& grip = config.grip;
  const double own = std::sqrt(grip.stiffness / (config.mass + grip.mass));  // [rad/s]
  double least = 1;
  for (int i = 1; i <= kParts; ++i) {
    const double share = static_cast<double>(i) / kParts;
    const double omega = share * own;  // [rad/s]
    const double passive = std::hypot(1 - share * share, grip.damping * omega / grip.stiffness);
    const double activation = 1 / (std::hypot(1, omega * Reaction::kExcitation) *
                                   std::hypot(1, omega * Reaction::kContraction));
    least = std::min(least, passive / activation);
  }
  return kMargin * least;
}

HandPlant::HandPlant(const HandPlantConfig& config, double position) noexcept
    : config_{config}, reaction_{config.reaction}, position_{position} {
  PALP_CHECK(config.step > Duration{0}, "a step takes time");
  PALP_CHECK(config.mass + config.grip.mass > 0, "a plant has mass");
  PALP_CHECK(config.friction_speed > 0, "friction turns over some speed");
}

double HandPlant::pull(double stretch, double rate, double load) noexcept {
  const Grip& grip = config_.grip;
  if (reaction_.none()) return grip.stiffness * stretch + grip.damping * rate;
  reaction_.step(stretch, load);
  const double tension = reaction_.tension();
  return tension * grip.stiffness * (stretch + reaction_.reflex()) +
         std::sqrt(tension) * grip.damping * rate;
}

void HandPlant::advance(const Pull& begin, const Pull& end, double force, Duration span) noexcept {
  const std::int64_t count = (span + config_.step - Duration{1}) / config_.step;
  const double dt = seconds(span) / static_cast<double>(count);
  const double whole = seconds(span);
  // The cubic through both ends: position = p + v t + q t^2 + c t^3.
  const double slope = (end.position - begin.position) / whole;
  const double q = (3 * slope - 2 * begin.velocity - end.velocity) / whole;
  const double c = (begin.velocity + end.velocity - 2 * slope) / (whole * whole);

  if (!reaction_.none()) reaction_.set_step(dt);
  const double gain = dt / (config_.mass + config_.grip.mass);
  const double per_speed = 1 / config_.friction_speed;
  const double started_at = position_;
  for (std::int64_t i = 0; i < count; ++i) {
    const double t = dt * static_cast<double>(i);
    const double aim = begin.position + t * (begin.velocity + t * (q + t * c));
    const double aim_rate = begin.velocity + t * (2 * q + t * 3 * c);
    const double pulled = pull(aim - position_, aim_rate - velocity_, force);
    const double drag =
        config_.damping * velocity_ + config_.friction * tanh_(velocity_ * per_speed);
    velocity_ += gain * (pulled - force - drag);
    position_ += dt * velocity_;
  }
  work_ += force * (position_ - started_at);
}

}  // namespace palp::surgeon
