#include "common/coupling/release_line.h"

#include <algorithm>

namespace palp::coupling {
namespace {

constexpr double kEnergyLeast = 1e-15;  // [J]

}  // namespace

ReleaseLineConfig at_device(ReleaseLineConfig line, const HandFacts& hand) noexcept {
  if (answer_delay(hand) > 0) line.steepest = line.soft;
  return line;
}

double ReleaseLine::steepest(double force) const noexcept {
  return std::clamp(std::max(force, plateau_) / config_.way, config_.soft, config_.steepest);
}

double ReleaseLine::least(double force) const noexcept {
  return 0.5 * force * force / steepest(force) + force * slack_;
}

void ReleaseLine::move(double moved) noexcept {
  if (moved < 0) {
    const double used = std::min(slack_, -moved);
    slack_ -= used;
    force_ = std::max(0.0, force_ + stiffness_ * (moved + used));
    return;
  }
  const double climbed = std::clamp(plateau_ - force_, 0.0, stiffness_ * moved);
  force_ += climbed;
  const double on = slack_ + moved - (holds() ? climbed / stiffness_ : 0);
  slack_ = std::min(on, config_.play);
  // Deeper than the play the hand takes it along.
  force_ += stiffness_ * (on - slack_);
  plateau_ = std::max(plateau_, force_);
}

void ReleaseLine::hold(double force, double energy) noexcept {
  const double left = std::max(kEnergyLeast, energy - force * slack_);
  stiffness_ = std::min(0.5 * force * force / left, steepest(force));
  force_ = force;
  plateau_ = std::max(plateau_, force);
  plateau_ -= std::min(1.0, config_.period / config_.settle) * (plateau_ - force);
}

}  // namespace palp::coupling
