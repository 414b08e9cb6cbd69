#include "surgeon_site/simulated_hand.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "common/core/limits.h"

namespace palp::surgeon {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::numbers::pi;

/// The intent is asked for, and the encoder read, once a part; one period is one part.
constexpr Duration kPartMax = microseconds{1500};
constexpr Duration kPauseMax = milliseconds{100};  ///< keeps read() within its 50 us

}  // namespace

HandFacts facts_of(const SimulatedHandConfig& config) noexcept {
  HandFacts facts;
  facts.force_peak = config.force_max;
  facts.force_continuous = config.force_continuous;
  return facts;
}

SimulatedHand::SimulatedHand(const SimulatedHandConfig& config, GestureScript script)
    : config_{config},
      person_{config.person, std::move(script)},
      plant_{config.plant, person_.intent().position},
      encoder_{config.encoder_step, config.velocity_cut_off, plant_.position()} {
  if (person_.script().has_tremor()) config_.tremor = 0;
  pull_ = pull();
  state_.position = encoder_.position();
  state_.place = person_.intent().place;
}

Pull SimulatedHand::pull() const noexcept {
  const Intent& intent = person_.intent();
  const double turn = 2 * pi * config_.tremor_frequency;
  const double angle = turn * seconds(age_);
  return {intent.position + config_.tremor * std::sin(angle),
          intent.velocity + config_.tremor * turn * std::cos(angle)};
}

void SimulatedHand::live(Duration span) noexcept {
  person_.step(span);
  age_ += span;
  const Pull next = pull();
  plant_.advance(pull_, next, force_, span);
  pull_ = next;
  encoder_.sample(plant_.position(), span);
  state_.position = encoder_.position();
  state_.velocity = encoder_.velocity();
}

HandState SimulatedHand::read(TimePoint now) noexcept {
  if (!started_) state_.sampled_at = now;
  started_ = true;
  Duration left = std::min(now - state_.sampled_at, kPauseMax);
  if (left > Duration{0}) {
    std::int64_t parts = (left + kPartMax - Duration{1}) / kPartMax;
    for (; parts > 0; --parts) {
      const Duration span = left / parts;
      left -= span;
      if (span > Duration{0}) live(span);
    }
    state_.sampled_at = now;
  }
  if (!held_in_plane_) state_.place = person_.intent().place;
  state_.pedal_held = person_.pedal_held();
  return state_;
}

void SimulatedHand::apply(double force) noexcept {
  force_ = std::clamp(finite_or(force, 0), -config_.force_max, config_.force_max);
}

HandTruth SimulatedHand::truth() const noexcept {
  return {plant_.position(),
          plant_.velocity(),
          force_,
          plant_.work(),
          person_.intent().position,
          person_.script_time(),
          person_.performing()};
}

}  // namespace palp::surgeon
