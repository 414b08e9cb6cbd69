#include "common/coupling/surface_drift.h"

#include <algorithm>
#include <cmath>

#include "common/coupling/contact_model.h"

namespace palp::coupling {
namespace {

constexpr double kPace = 8;            // [rad/s], of the filter, critically damped
constexpr double kBreath = 1.6;        // [rad/s], of a breath
constexpr double kSlow = 2e-3;         // [m/s], of the tip lately: up to here the surface moves it
constexpr double kQuick = 4e-3;        // [m/s], and from here on the hand does: taps say nothing
constexpr double kForgottenBy = 1e-3;  // [m], of the tip's way
constexpr double kFelt = 0.03;         // [N], told
constexpr double kFarthest = 4e-3;     // [m]
constexpr double kSpeedMost = 8e-3;    // [m/s], of the surface
constexpr double kOffMost = 1e-3;      // [m], that one reading is believed
constexpr double kSpeedLasts = 0.3;    // [s], where nothing is seen of it
constexpr double kDriftLasts = 2;      // [s], likewise
constexpr double kFade = 0.3;          // [s]
constexpr double kNothing = 1e-6;      // [m], is left

}  // namespace

void SurfaceDrift::fade() noexcept {
  const double kept = 1 - period_ / kFade;
  drift_ *= kept;
  speed_ *= kept;
  if (std::hypot(drift_, speed_ / kBreath) < kNothing) forget();
}

/// A tip in the air says nothing of a surface below it.
void SurfaceDrift::coast() noexcept {
  speed_ *= 1 - period_ / kSpeedLasts;
  drift_ *= 1 - period_ / kDriftLasts;
  drift_ += period_ * speed_;
}

void SurfaceDrift::step(const ModelPayload& model, const Met& met) noexcept {
  const double kept = std::exp(-std::abs(met.position - position_) / kForgottenBy);
  position_ = met.position;
  drift_ *= kept;
  speed_ *= kept;
  if (model.version == 0) return;
  const double depth = met.position - model.surface - model.swing;
  if (!met.touches && (met.given < kFelt || depth <= 0)) return coast();
  double off = depth;  // [m], that the surface is deeper: by all of it where nothing is felt
  if (met.touches) {
    const ContactModel elastic = contact_model(model);
    // What relaxed is no motion of the surface.
    const double elastic_share = met.given > kFelt ? elastic.force(depth) / met.given : 1;
    off = depth - elastic.depth(met.force * elastic_share);
  }
  off = std::clamp(off, -kOffMost, kOffMost);
  const double share = std::clamp((kQuick - met.speed) / (kQuick - kSlow), 0.0, 1.0);
  speed_ += period_ * (share * kPace * kPace * off - (1 - share) / kSpeedLasts * speed_);
  speed_ = std::clamp(speed_, -kSpeedMost, kSpeedMost);
  drift_ += period_ * (share * 2 * kPace * off + speed_);
  drift_ = std::clamp(drift_, -kFarthest, kFarthest);
}

ModelPayload SurfaceDrift::moved(ModelPayload model) const noexcept {
  if (drift_ == 0 && speed_ == 0) return model;
  if (model.swing_rate == 0) model.swing_rate = kBreath;
  model.swing = std::clamp(model.swing + drift_, -kFarthest, kFarthest);
  model.swing_quadrature =
      std::clamp(model.swing_quadrature + speed_ / model.swing_rate, -kFarthest, kFarthest);
  return model;
}

}  // namespace palp::coupling
