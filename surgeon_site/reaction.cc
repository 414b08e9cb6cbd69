#include "surgeon_site/reaction.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"

namespace palp::surgeon {

Reaction::Reaction(const ReactionConfig& config) noexcept
    : config_{config}, none_{!(config.reflex > 0) && !(config.co_contraction > 0)} {
  PALP_CHECK(config.reflex >= 0 && config.co_contraction >= 0, "a hand reacts against its load");
  PALP_CHECK(config.reflex_delay >= kDelayMin && config.reflex_delay <= kDelayMax,
             "a reflex takes 20 to 150 ms");
}

void Reaction::set_step(double dt) noexcept {
  dt_ = dt;
  excitation_gain_ = 1 - std::exp(-dt / kExcitation);
  contraction_gain_ = 1 - std::exp(-dt / kContraction);
  tensing_gain_ = 1 - std::exp(-dt / kTensing);
}

void Reaction::step(double stretch, double load) noexcept {
  load_ += tensing_gain_ * (std::abs(load) - load_);
  if (!(config_.reflex > 0)) return;
  keep(stretch);
  excited_ += excitation_gain_ * (late_stretch() - excited_);
  contracted_ += contraction_gain_ * (excited_ - contracted_);
}

double Reaction::tension() const noexcept {
  return std::min(kTensest, 1 + config_.co_contraction * load_);
}

void Reaction::keep(double stretch) noexcept {
  since_ += dt_;
  while (since_ >= kRaster) {  // dt / kRaster times, once for the step of 0.1 ms
    since_ -= kRaster;
    newest_ = newest_ + 1 < kKept ? newest_ + 1 : 0;
    kept_[newest_] = stretch + (stretch_ - stretch) * (since_ / dt_);
  }
  stretch_ = stretch;
}

double Reaction::late_stretch() const noexcept {
  const double behind = (seconds(config_.reflex_delay) - since_) / kRaster;
  const auto whole = static_cast<std::size_t>(behind);
  const double part = behind - static_cast<double>(whole);
  const double later = kept_[(newest_ + kKept - whole) % kKept];
  const double earlier = kept_[(newest_ + kKept - whole - 1) % kKept];
  return later + part * (earlier - later);
}

}  // namespace palp::surgeon
