#include "common/coupling/direct.h"

#include <utility>

namespace palp::coupling {
namespace {

ForceGrowthConfig with_spring(ForceGrowthConfig change, double spring) noexcept {
  change.stiffness += spring;
  return change;
}

}  // namespace

DirectSurgeon::DirectSurgeon(const DirectConfig& config) noexcept
    : config_{config}, change_{with_spring(config.change, config.position_scale * config.spring)} {}

void DirectSurgeon::begin_epoch(double position) noexcept {
  heard_ = false;
  force_ = 0;
  position_ = position;
  change_.forget();
  fade_.set(1);  // nothing was heard, so the force is zero: there is nothing to fade in
}

SurgeonOutput DirectSurgeon::step(const SurgeonInput& in, const Lapse& lapse) noexcept {
  if (const Incoming* last = newest(in.arrived)) {
    tip_ = last->sample;
    heard_ = true;
  }
  if (in.state == SiteState::Engaged) {
    fade_.rise(seconds(lapse.period), config_.fade_in);
  } else {
    fade_.fall(seconds(lapse.period), config_.fade_out);
  }
  double force = 0;
  if (heard_) {
    const double ahead = config_.position_scale * in.position - tip_.position;
    force = config_.force_scale * tip_.force + config_.spring * ahead;  // paper eq. (1)
  }
  change_.move(in.position - std::exchange(position_, in.position), in.velocity, lapse);
  force_ = change_.change(force_, fade_.value() * force);
  return {force_, {in.position, in.velocity, force_, std::monostate{}}};
}

void DirectPatient::begin_epoch(double position) noexcept { target_ = position; }

PatientOutput DirectPatient::step(const PatientInput& in, const Lapse& /*lapse*/) noexcept {
  if (const Incoming* last = newest(in.arrived)) {
    target_ = config_.position_scale * last->sample.position;
  }
  return {target_, {in.position, in.velocity, in.contact_force, std::monostate{}}};
}

}  // namespace palp::coupling
