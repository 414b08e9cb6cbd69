#include "surgeon_site/pointer_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/limits.h"

namespace palp::surgeon {
namespace {

using std::chrono::milliseconds;

constexpr double kStart = -10e-3;  ///< [m], where a hand waits at first
constexpr Duration kStepMax = milliseconds{2};
constexpr Duration kNapMax = milliseconds{100};  ///< keeps read() within its 50 us

double within(double value, double most) noexcept {
  return std::clamp(finite_or(value, 0), -most, most);
}

}  // namespace

PointerHand::PointerHand(const PointerHandConfig& config)
    : config_{config},
      plant_{config.plant, kStart},
      encoder_{config.encoder_step, config.velocity_cut_off, kStart},
      pull_{kStart, 0} {
  state_.position = encoder_.position();
}

HandFacts PointerHand::hand_facts() const noexcept {
  HandFacts facts;
  facts.force_peak = config_.force_max;
  facts.force_continuous = config_.force_continuous;
  return facts;
}

void PointerHand::Will::follow(double aim, double gain, double step_max) noexcept {
  smooth += gain * (aim - smooth);
  now = step_towards(now, smooth, step_max);
}

void PointerHand::keep(const Drawn& drawn) noexcept { kept_[count_++ % kKept] = drawn; }

/// The finger went down: whatever it is drawn by from here on, the hand is where it is.
void PointerHand::press(const PointerReport& report) noexcept {
  press_ = report.press;
  base_ = plant_.position();
  base_place_ = state_.place;
  into_ = x_ = y_ = {};
  count_ = 0;
  keep({.at = report.arrived_at});
}

/// The hand rests where it is.
void PointerHand::let_go() noexcept {
  over_ = std::max(over_, press_);
  press_ = 0;
  pull_ = {.position = plant_.position(), .velocity = 0};
}

/// What ends a press: the finger is up, another one is down, or nothing was heard for too long. The
/// next begins a tick later at the soonest, so that the pedal is seen to be up.
void PointerHand::hear(TimePoint now) noexcept {
  const PointerReport report = reports_.get();
  const bool in_time = elapsed(report.arrived_at, now) <= config_.silence_max;
  const bool down = report.held && in_time && report.press > over_;
  if (!down) over_ = std::max(over_, report.press);
  if (press_ != 0 && (!down || report.press != press_)) return let_go();
  if (!down) return;
  if (press_ == 0) press(report);
  if (report.arrived_at == heard_at_) return;
  heard_at_ = report.arrived_at;
  keep({.at = report.arrived_at,
        .into = within(report.into, config_.reach),
        .x = within(report.x, config_.reach_aside),
        .y = within(report.y, config_.reach_aside)});
}

/// On the line between the reports around that time; behind the newest it stays.
PointerHand::Drawn PointerHand::drawn_at(TimePoint at) const noexcept {
  const std::size_t there = std::min(count_, kKept);
  Drawn later = kept_[(count_ - 1) % kKept];
  if (at >= later.at) return later;
  for (std::size_t back = 2; back <= there; ++back) {
    const Drawn& earlier = kept_[(count_ - back) % kKept];
    if (earlier.at <= at) {
      const double share = seconds(at - earlier.at) / seconds(later.at - earlier.at);
      return {.at = at,
              .into = std::lerp(earlier.into, later.into, share),
              .x = std::lerp(earlier.x, later.x, share),
              .y = std::lerp(earlier.y, later.y, share)};
    }
    later = earlier;
  }
  return later;
}

void PointerHand::live(Duration span) noexcept {
  const double dt = seconds(span);
  Pull next{.position = pull_.position, .velocity = 0};
  if (press_ != 0) {
    const Drawn aim = drawn_at(state_.sampled_at - config_.play_out);
    const double gain = 1 - std::exp(-2 * std::numbers::pi * config_.will_cut_off * dt);
    const double step_max = config_.speed_max * dt;
    into_.follow(aim.into, gain, step_max);
    x_.follow(aim.x, gain, step_max);
    y_.follow(aim.y, gain, step_max);
    next.position = base_ + into_.now;
    next.velocity = (next.position - pull_.position) / dt;
    state_.place = {base_place_.x + x_.now, base_place_.y + y_.now};
  }
  plant_.advance(pull_, next, force_, span);
  pull_ = next;
  encoder_.sample(plant_.position(), span);
}

HandState PointerHand::read(TimePoint now) noexcept {
  if (!started_) state_.sampled_at = now;
  started_ = true;
  hear(now);
  Duration left = std::min(now - state_.sampled_at, Duration{kNapMax});
  state_.sampled_at = now - std::max(left, Duration{0});
  while (left > Duration{0}) {
    const Duration span = std::min(left, Duration{kStepMax});
    left -= span;
    state_.sampled_at += span;
    live(span);
  }
  state_.position = encoder_.position();
  state_.velocity = encoder_.velocity();
  state_.pedal_held = press_ != 0;
  return state_;
}

void PointerHand::apply(double force) noexcept { force_ = within(force, config_.force_max); }

}  // namespace palp::surgeon
