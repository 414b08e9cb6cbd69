#include "depth/stroke_cutter.h"

#include <algorithm>

#include "common/core/check.h"

namespace palp::depth {

StrokeCutter::StrokeCutter(const StrokeCutterConfig& config) : config_{config} {
  PALP_CHECK(config.lead >= 2 && config.stroke_max >= 4 * config.lead,
             "a stroke outlasts its lead");
  samples_.reserve(config.stroke_max);
}

void StrokeCutter::reset() noexcept {
  phase_ = Phase::Unknown;
  samples_.clear();
  deepest_ = 0;
  stride_ = 1;
  skipped_ = 0;
  pressed_again_ = false;
}

std::span<const StrokeSample> StrokeCutter::loading() const noexcept {
  return std::span{samples_}.first(std::min(loading_count(), samples_.size()));
}

StrokeCutter::Event StrokeCutter::add(const StrokeSample& sample) {
  if (phase_ == Phase::Done) reset();
  switch (phase_) {
    case Phase::Unknown:
    case Phase::Done:
      // A stream that begins in contact has no air to find the surface in: wait for release.
      if (sample.force < config_.contact_force / 2) {
        phase_ = Phase::Air;
        keep_lead(sample);
      }
      return Event::None;
    case Phase::Air:
      if (sample.force < config_.contact_force) {
        keep_lead(sample);
        return Event::None;
      }
      phase_ = Phase::Loading;
      deepest_ = samples_.empty() ? 0 : samples_.size() - 1;
      return follow(sample);
    case Phase::Loading:
    case Phase::Unloading:
      return follow(sample);
  }
  return Event::None;
}

/// The lead begins where the tip was farthest out: before that it came back from another stroke.
void StrokeCutter::keep_lead(const StrokeSample& sample) {
  if (!samples_.empty() && sample.position <= samples_.front().position) samples_.clear();
  if (samples_.size() >= 2 * config_.lead) {
    samples_.erase(samples_.begin(),
                   samples_.begin() + static_cast<std::ptrdiff_t>(samples_.size() - config_.lead));
  }
  samples_.push_back(sample);
}

void StrokeCutter::keep(const StrokeSample& sample) {
  if (++skipped_ < stride_) return;
  skipped_ = 0;
  if (samples_.size() == config_.stroke_max) {
    for (std::size_t i = 0; 2 * i < samples_.size(); ++i) samples_[i] = samples_[2 * i];
    samples_.resize(samples_.size() / 2);
    deepest_ = std::min(deepest_ / 2, samples_.size() - 1);
    stride_ *= 2;
  }
  samples_.push_back(sample);
}

StrokeCutter::Event StrokeCutter::follow(const StrokeSample& sample) {
  keep(sample);
  const double back = samples_[deepest_].position - sample.position;
  if (phase_ == Phase::Loading) {
    if (back <= 0) deepest_ = samples_.size() - 1;
    if (back > config_.reversal) {
      phase_ = Phase::Unloading;
      return Event::Reversed;
    }
    return Event::None;
  }
  if (back < -config_.reversal) {
    phase_ = Phase::Loading;
    pressed_again_ = true;
    deepest_ = samples_.size() - 1;
    return Event::None;
  }
  if (sample.force < config_.contact_force / 2) {
    phase_ = Phase::Done;
    return Event::Released;
  }
  return Event::None;
}

}  // namespace palp::depth
