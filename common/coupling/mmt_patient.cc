/// The patient's half of `mmt`.

#include <algorithm>
#include <cmath>

#include "common/coupling/mmt.h"

namespace palp::coupling {
namespace {

constexpr Duration kStale = std::chrono::milliseconds{20};  // older speed is soon no speed
constexpr double kStops = 10e-3;                            // [s], that it takes
constexpr double kDragged = 0.1;  // [N], of a tip that is in the tissue as it goes along

ContactEstimatorConfig with_sensor(ContactEstimatorConfig config,
                                   const ForceSensorFacts& sensor) noexcept {
  config.sensor = sensor;
  return config;
}

}  // namespace

MmtPatient::MmtPatient(const MmtConfig& config, const PatientDevices& devices) noexcept
    : config_{config},
      // A target stands for a tick: what is led beyond whole ones would be led too far.
      stage_lead_{std::floor(devices.stage.lag / config.period) * config.period},
      paired_{devices, config.period},
      estimator_{with_sensor(config.estimator, devices.sensor)},
      since_drag_{config.drag_memory} {}

void MmtPatient::begin_epoch(double position) noexcept {
  hand_ = position;
  hand_velocity_ = 0;
  hand_force_ = 0;
  yielded_ = 0;
}

/// A hand that is not heard of is taken to stand still.
double MmtPatient::target(const PatientInput& in, const Lapse& lapse) noexcept {
  const Incoming* last = newest(in.arrived);
  if (last != nullptr) {
    hand_ = last->sample.position;
    hand_velocity_ = finite_or(last->sample.velocity, 0);
    hand_force_ = finite_or(last->sample.force, 0);
    heard_at_ = in.now;
  }
  if (in.now - heard_at_ > kStale) hand_velocity_ *= std::exp(-seconds(lapse.passed()) / kStops);
  const double lead = std::min(config_.lead_max, stage_lead_ + 0.5 * seconds(in.round_trip));
  const double led = hand_ + lead * hand_velocity_;
  return led - std::max(yielded_, behind_in_drag(led));
}

/// [N], from here on the tip gives way: little harder than the hand was given last.
double MmtPatient::allowed() const noexcept {
  return config_.unfelt + (1 + config_.unfelt_share) * std::max(0.0, hand_force_);
}

void MmtPatient::notice_drag(const PatientInput& in, double span) noexcept {
  since_drag_ += span;
  const bool elsewhere = began_ && distance(in.place, place_) > kSamePlace;
  if (elsewhere && in.contact_force > kDragged) since_drag_ = 0;
}

/// A finger gives way to a tissue that breathes against it, or is stiffer than the model says. So
/// does the tip, slowly enough not to swing between a slow stage and a slow sensor.
void MmtPatient::give_way(double force, double span) noexcept {
  const double pressed = finite_or(force, 0) - allowed();
  yielded_ = std::clamp(yielded_ + config_.yield * pressed * span, 0.0, config_.yield_most);
}

/// A finger that is dragged over something hard gives way to it at once; a hand over a long path
/// does so late, and until then the tip would press as deep as beside it. Both ends know the same
/// tissue, so the model says where to wait. @returns how far behind `led` that is [m].
double MmtPatient::behind_in_drag(double led) const noexcept {
  const ModelPayload& found = estimator_.model();
  if (found.version == 0 || since_drag_ >= config_.drag_memory) return 0;
  const ContactModel model = contact_model(found);
  const double depth = led - model.surface - found.swing;
  const double most =
      config_.unfelt_drag + (1 + config_.unfelt_drag_share) * std::max(0.0, hand_force_);
  return model.force(depth) > most ? depth - model.depth(most) : 0;
}

PatientOutput MmtPatient::step(const PatientInput& in, const Lapse& lapse) noexcept {
  give_way(in.contact_force, seconds(lapse.period));
  notice_drag(in, seconds(lapse.period));
  const double aim = target(in, lapse);
  if (!began_ || distance(in.place, place_) > kSamePlace) {
    estimator_.new_place(in.place);
    place_ = in.place;
  }
  began_ = true;
  const PairedReadings::Pair pair = paired_.step(
      in.now, in.now - in.position_age, in.position, in.now - in.force_age, in.contact_force);
  estimator_.step(pair.position, pair.force, lapse.periods);
  // A finger that goes into a tissue feels it at once; a hand over a long path goes on as if there
  // was none. The tip does not go with it.
  return {.target_position = aim,
          .to_surgeon = {in.position, in.velocity, in.contact_force, estimator_.model()},
          .force_most = allowed() + config_.braked_beyond};
}

}  // namespace palp::coupling
