#include "common/coupling/held_force.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kTime = 0.2;          // [s], that a correction takes
constexpr double kLately = 0.4;        // [s]
constexpr double kMoves = 3e-3;        // [m/s], of the tip lately: faster, and the fit learns
constexpr double kForgotten = 0.5e-3;  // [m], of way
constexpr double kForceLeast = 0.03;   // [N], of the model: of less no share is taken
constexpr double kShareMost = 0.5;     // [-]

}  // namespace

void HeldForce::step(const ModelPayload& model,
                     double position,
                     double force,
                     double doubt) noexcept {
  const double moved = std::abs(position - position_);
  position_ = position;
  speed_ += period_ / kLately * (moved / period_ - speed_);
  share_ *= std::exp(-moved / kForgotten);
  if (model.version == 0) return;
  const double depth = position - model.surface - model.swing;
  given_.age_into(contact_model(corrected(model)), model.relaxing, depth, period_);
  force_ = given_.force(depth);
  const double still = std::max(0.0, 1 - speed_ / kMoves);
  const double off = force - force_;
  const double left = off - std::clamp(off, -doubt, doubt);
  share_ += still * period_ / kTime * left / std::max(force_, kForceLeast);
  share_ = std::clamp(share_, -kShareMost, kShareMost);
}

ModelPayload HeldForce::corrected(ModelPayload model) const noexcept {
  for (double& coefficient : model.c) coefficient *= 1 + share_;
  for (double& stiffness : model.stiffness) stiffness *= 1 + share_;
  return model;
}

}  // namespace palp::coupling
