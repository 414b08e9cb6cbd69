#include "common/coupling/wave.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kWaveMeanGain = 0.1;  // per tick: 10 ms
constexpr double kEchoUnfelt = 0.05;   // [s], a round trip after which an echo joins its call ...
constexpr double kEchoFelt = 0.1;      // [s], ... and one after which it is felt by itself

void send(WavePayload& sent, double wave, double period) noexcept {
  sent.wave_integral += wave * period;
  sent.wave_energy += 0.5 * wave * wave * period;
}

}  // namespace

double wave_impedance(const WaveConfig& config, const PatientDevices& devices) noexcept {
  if (config.impedance > 0) return config.impedance;
  const double lag = devices.stage.lag + devices.sensor.lag;
  return std::clamp(1.2 * config.stiffness_expected * lag, 5.0, 15.0);
}

WaveSurgeon::WaveSurgeon(const WaveConfig& config, const PatientDevices& devices) noexcept
    : config_{config},
      impedance_{wave_impedance(config, devices)},
      root_{std::sqrt(2 * impedance_)},
      velocity_{config.velocity_cut_off, config.period},
      play_out_{config.period},
      told_{{.stiffness = config.stiffness_expected}},
      tank_{config.tank} {}

void WaveSurgeon::meet(const PatientDevices& devices) noexcept {
  impedance_ = wave_impedance(config_, devices);
  root_ = std::sqrt(2 * impedance_);
}

void WaveSurgeon::begin_epoch(double position) noexcept {
  tank_.begin_epoch(position);
  velocity_.reset();
  play_out_.restart();
  sent_ = {};
  presence_.set(1);
  told_.begin_epoch();
}

/// What went through the port since the last tick. @returns what came out of it as a wave.
HeldWave WaveSurgeon::account(const SurgeonInput& in, double way, const Lapse& lapse) noexcept {
  if (!lapse.late()) return {};
  const double pace = impedance_ * way / seconds(lapse.passed());
  if (in.state == SiteState::Engaged) {
    send(sent_, (pace + in.force_applied) / root_, lapse.held());
  }
  return {(pace - in.force_applied) / root_, lapse.held()};
}

SurgeonOutput WaveSurgeon::step(const SurgeonInput& in, const Lapse& lapse) noexcept {
  const double way = tank_.account(in.force_applied, in.position);
  const HeldWave held = account(in, way, lapse);
  const double speed = velocity_.step(in.position, lapse.periods);
  const double wave = play_out_.step(in.now, in.arrived, held);
  if (in.state == SiteState::Retract) presence_.fall(seconds(lapse.period), config_.fade);
  const double most = tank_.force_max();
  const double told = std::clamp(told_.step(root_ * wave, way, lapse), -most, most);
  told_.cut_to(told);
  const double force = (impedance_ * speed - told) * presence_.value();
  // Only in Engaged does the hand speak: a wave sent in Hold would be a step when it is over.
  if (in.state == SiteState::Engaged) {
    send(sent_, (impedance_ * speed + force) / root_, config_.period);
  }
  return {force, {in.position, in.velocity, force, sent_}};
}

WavePatient::WavePatient(const WaveConfig& config, const PatientDevices& devices) noexcept
    : config_{config},
      impedance_{wave_impedance(config, devices)},
      root_{std::sqrt(2 * impedance_)},
      play_out_{config.period} {}

void WavePatient::begin_epoch(double position) noexcept {
  play_out_.restart();
  sent_ = {};
  target_ = position;
  hand_ = position;
}

/// [N s/m]: matched where an echo comes late.
double WavePatient::termination(Duration round_trip) const noexcept {
  const double late = (seconds(round_trip) - kEchoUnfelt) / (kEchoFelt - kEchoUnfelt);
  return impedance_ * std::lerp(config_.termination, 1.0, std::clamp(late, 0.0, 1.0));
}

PatientOutput WavePatient::step(const PatientInput& in, const Lapse& lapse) noexcept {
  // While nobody commanded it the stage stood, and the tissue pressed on it.
  const double force = std::max(0.0, in.contact_force);
  const double wave = play_out_.step(in.now, in.arrived, {force / root_, lapse.held()});
  if (const Incoming* last = newest(in.arrived)) hand_ = last->sample.position;
  force_mean_ += kWaveMeanGain * (in.contact_force - force_mean_);
  if (in.state != SiteState::Engaged) {
    target_ = in.position;
    return {target_, {in.position, in.velocity, in.contact_force, sent_}};
  }
  if (lapse.late()) send(sent_, -force / root_, lapse.held());
  const double end = termination(in.round_trip);
  const double speed = (root_ * wave - force) / (impedance_ + end);
  const double port = force + end * speed;
  send(sent_, (impedance_ * speed - port) / root_, config_.period);
  target_ += speed * config_.period;
  if (force_mean_ < config_.contact_zero && force == 0) {
    const double drift = config_.drift_rate * (hand_ - target_);
    target_ += std::clamp(drift, -config_.drift_speed, config_.drift_speed) * config_.period;
  }
  return {target_, {in.position, in.velocity, in.contact_force, sent_}};
}

}  // namespace palp::coupling
