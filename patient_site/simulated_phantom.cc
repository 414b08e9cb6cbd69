#include "patient_site/simulated_phantom.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/check.h"
#include "common/core/limits.h"
#include "common/core/random.h"
#include "patient_site/balanced_force.h"

namespace palp::patient {
namespace {

constexpr Duration kStep = std::chrono::microseconds{100};
constexpr double kStepSeconds = 1e-4;
// A process that was stopped for longer than this resumes where it was: the loop stays bounded.
constexpr std::int64_t kStepsMax = 2'000;
constexpr std::uint64_t kForceNoiseStream = 0x666f726365;  // "force"

Place within(const Place& place, double travel) noexcept {
  return {std::clamp(place.x, -travel / 2, travel / 2),
          std::clamp(place.y, -travel / 2, travel / 2)};
}

double rounded(double value, double quantum) noexcept {
  return quantum > 0 ? quantum * std::round(value / quantum) : value;
}

/// [s], as a data sheet gives it.
double to_tenth_of_millisecond(double span) noexcept { return std::round(span * 1e4) / 1e4; }

}  // namespace

PatientDevices facts_of(const SimulatedPhantomConfig& config) noexcept {
  PatientDevices facts;
  facts.stage.speed = config.speed_max;
  facts.stage.acceleration = config.acceleration_max;
  facts.stage.lag = config.stage_lag;
  facts.stage.travel_side = config.plane_travel / 2;
  facts.stage.drags = config.can_drag;
  facts.sensor.pole = config.sensor_cut_off;
  facts.sensor.step = config.force_quantum;
  facts.sensor.noise = config.force_noise;
  facts.sensor.yield = config.yield_stated * config.yield;
  facts.sensor.lag = to_tenth_of_millisecond(1 / (2 * std::numbers::pi * config.sensor_cut_off));
  return facts;
}

Breath breath_of(const SimulatedPhantomConfig& config) noexcept {
  return Breath{{.amplitude = config.breathing_amplitude,
                 .frequency = config.breathing_frequency,
                 .variation = config.breathing_variation,
                 .seed = config.seed}};
}

SimulatedPhantom::SimulatedPhantom(const Phantom& phantom, const SimulatedPhantomConfig& config)
    : config_{config},
      field_{make_field(phantom, config.viscous_factor)},
      target_{config.start_position, config.start_place},
      position_{config.start_position},
      tip_{config.start_position},
      place_{config.start_place},
      surface_{config.surface_offset + field_->surface(config.start_place)},
      relaxing_{phantom.relaxation},
      breath_{breath_of(config)} {
  PALP_CHECK(config.servo_frequency > 0 && config.sensor_cut_off > 0, "frequencies are positive");
  PALP_CHECK(config.servo_stiffness >= 0 && config.yield >= 0, "nothing yields backwards");
  const double omega = 2 * std::numbers::pi * config.servo_frequency;
  servo_pull_ = omega * omega;
  servo_drag_ = 2 * config.servo_damping * omega;
  servo_yield_ = config.servo_stiffness > 0 ? 1 / config.servo_stiffness : 0;
  sensor_gain_ = 1 - std::exp(-2 * std::numbers::pi * config.sensor_cut_off * kStepSeconds);
}

StageState SimulatedPhantom::read(TimePoint now) noexcept {
  advance(now);
  return {.sampled_at = now,
          .position = rounded(position_, config_.encoder_step),
          .velocity = velocity_,
          .place = place_,
          .at_limit = target_.place != within(target_.place, config_.plane_travel),
          .faulted = false};
}

void SimulatedPhantom::move_to(const StageTarget& target) noexcept {
  if (!std::isfinite(target.position) || !is_finite(target.place)) return halt();
  target_ = target;
}

/// Against what presses now: a target at the tip would give way a little with every call.
void SimulatedPhantom::halt() noexcept {
  target_.position = position_ + servo_yield_ * contact_force_;
  target_.place = place_;
}

std::optional<ForceSample> SimulatedPhantom::sample(TimePoint now) noexcept {
  advance(now);
  noisy_force_ = sensed_force_;
  if (config_.force_noise > 0) {
    noisy_force_ += config_.force_noise * random_normal(config_.seed, kForceNoiseStream, steps_);
  }
  return ForceSample{
      .sampled_at = now, .force = rounded(noisy_force_, config_.force_quantum), .saturated = false};
}

void SimulatedPhantom::advance(TimePoint now) noexcept {
  if (!started_) {
    started_ = true;
    at_ = now;
  }
  const std::int64_t due = (now - at_) / kStep;
  if (due <= 0) return;
  for (std::int64_t i = 0; i < std::min(due, kStepsMax); ++i) integrate_step();
  at_ += due * kStep;
}

void SimulatedPhantom::integrate_step() noexcept {
  const double pull = servo_pull_ * (target_.position - position_) - servo_drag_ * velocity_;
  // The limit is the motor's; the tissue pushes as it likes.
  const double acceleration =
      std::clamp(pull, -config_.acceleration_max, config_.acceleration_max) -
      servo_pull_ * servo_yield_ * contact_force_;
  velocity_ =
      std::clamp(velocity_ + acceleration * kStepSeconds, -config_.speed_max, config_.speed_max);
  position_ += velocity_ * kStepSeconds;
  const Place there = within(target_.place, config_.plane_travel);
  const double way_max = config_.plane_speed_max * kStepSeconds;
  place_ = {step_towards(place_.x, there.x, way_max), step_towards(place_.y, there.y, way_max)};
  ++steps_;

  const Breath::Motion breath = breath_.at(kStepSeconds * static_cast<double>(steps_));
  surface_ = config_.surface_offset + field_->surface(place_) + breath.position;
  touch(breath.velocity);
  sensed_force_ += sensor_gain_ * (contact_force_ - sensed_force_);
}

/// The tip's velocity is that of the whole step, for both kinds: so no step gives back more energy
/// than an elastic tissue holds.
void SimulatedPhantom::touch(double surface_rate) noexcept {
  const double stood = tip_;
  tip_ = position_;
  tip_velocity_ = velocity_;
  if (config_.yield > 0) {
    tip_ -= config_.yield * force_behind_yield(stood, surface_rate);
    tip_velocity_ = (tip_ - stood) / kStepSeconds;
  }
  const double elastic =
      relaxing_.step(field_->elastic_force(place_, tip_ - surface_), kStepSeconds);
  contact_force_ = std::max(0.0, elastic * field_->growth(tip_velocity_ - surface_rate));
  tissue_energy_ += contact_force_ * tip_velocity_ * kStepSeconds;
}

/// Of the end of this step, at which the tip will stand where that force lets it: so a tissue that
/// is stiff beside the yield makes nothing swing.
double SimulatedPhantom::force_behind_yield(double stood, double surface_rate) const noexcept {
  const auto answer = [&](double force) {
    const double tip = position_ - config_.yield * force;
    const double elastic =
        RelaxingForce{relaxing_}.step(field_->elastic_force(place_, tip - surface_), kStepSeconds);
    const double rate = (tip - stood) / kStepSeconds - surface_rate;
    return std::max(0.0, elastic * field_->growth(rate));
  };
  return balanced_force(answer, contact_force_);
}

PhantomTruth SimulatedPhantom::truth() const noexcept {
  return {.position = tip_,
          .velocity = tip_velocity_,
          .place = place_,
          .surface = surface_,
          .contact_force = contact_force_,
          .noisy_force = noisy_force_,
          .tissue_energy = tissue_energy_};
}

}  // namespace palp::patient
