#include "patient_site/motion_gate.h"

#include <algorithm>
#include <cmath>

#include "common/core/limits.h"

namespace palp::patient {
namespace {

using record::NoteCode;

constexpr double kSmoothing = 0.1;        // per tick: 10 ms
constexpr double kFeltShare = 0.4;        // of contact_force, smoothed: noise alone is no contact
constexpr double kNoiseShare = 1.4;       // six standard deviations of a mean over 10 ms
constexpr double kNoiseSmoothing = 1e-3;  // per tick: 1 s
constexpr int kDoubtTicks = 60;      // a contact that ends sooner, and not by leaving, was none
constexpr double kLeft = 0.2e-3;     // [m], outwards: the tip was moved out
constexpr double kOutside = 0.5e-3;  // [m], of the learned surface: more than its error
constexpr double kInside = 1e-3;     // [m], the same to the other side, and some force
constexpr double kRetractedWithin = 50e-6;  // [m]
constexpr double kRetreatGrowth = 3;        // of the retreat's speed, at most
constexpr double kTooDeep = 2e-3;           // [m], more than a servo overshoots

}  // namespace

void MotionGate::begin(double tip, const Place& place) noexcept {
  command_ = tip;
  velocity_ = 0;
  foresight_.begin(tip);
  doubt_.reset();
  plane_.begin(place);
}

void MotionGate::hold() noexcept {
  velocity_ = 0;
  plane_.hold();
}

void MotionGate::feel(double tip, double contact_force, std::optional<double> age) noexcept {
  foresight_.feel(tip, contact_force, age);
  felt_ += kSmoothing * (contact_force - felt_);
  if (surface_of_this_place_ && !doubt_) return;
  const double least =
      std::max(kFeltShare * config_.contact_force, kNoiseShare * std::sqrt(noise_square_));
  doubt_surface(tip, least);
  if (surface_of_this_place_) return;
  const bool contact = contact_force >= config_.contact_force && felt_ >= least;
  if (!contact) {
    if (felt_ < least) {
      noise_square_ += kNoiseSmoothing * (contact_force * contact_force - noise_square_);
    }
    return;
  }
  learn_surface(tip);
}

void MotionGate::learn_surface(double tip) noexcept {
  doubt_ = Doubt{.surface = surface_, .place = surface_place_, .tip = tip};
  // Contact began where Hertz' law of the expected tissue gives no force.
  const double force = std::max(felt_, config_.contact_force / 2) / config_.contact_stiffness;
  surface_ = foresight_.felt_tip() - std::cbrt(force * force);
  surface_place_ = plane_.command();
  surface_of_this_place_ = true;
}

/// One wrong sample of the sensor must not shut the way to the tissue.
void MotionGate::doubt_surface(double tip, double least) noexcept {
  if (!doubt_) return;
  if (++doubt_->ticks > kDoubtTicks || tip < doubt_->tip - kLeft) {
    doubt_.reset();
  } else if (felt_ < least) {
    surface_ = doubt_->surface;
    surface_place_ = doubt_->place;
    surface_of_this_place_ = false;
    doubt_.reset();
  }
}

bool MotionGate::outside(double tip) const noexcept {
  return felt_ < config_.contact_force && (!surface_ || tip < *surface_ - kOutside);
}

bool MotionGate::free_to_follow(double tip) const noexcept {
  return felt_ < config_.contact_force || (surface_ && tip < *surface_ - kOutside);
}

bool MotionGate::inside(double tip) const noexcept {
  return surface_of_this_place_ && surface_ && tip > *surface_ + kInside;
}

double MotionGate::clear_position() const noexcept { return *surface_ - config_.clearance; }

bool MotionGate::retracted(double tip) const noexcept {
  if (!surface_) return felt_ < config_.contact_force;
  return tip <= clear_position() + kRetractedWithin;
}

double MotionGate::deepest() const noexcept {
  const double deepest =
      surface_ ? std::min(config_.travel_max, *surface_ + config_.depth_max) : config_.travel_max;
  return std::max(deepest, config_.travel_min);
}

double MotionGate::within_limits(double position) const noexcept {
  return std::clamp(position, config_.travel_min, deepest());
}

bool MotionGate::too_deep(double tip) const noexcept {
  return tip > std::max(deepest(), command_) + kTooDeep;
}

/// Where no surface is known, the next step may meet one.
double MotionGate::speed_limit(double target) const noexcept {
  if (resynchronising_) return config_.speed_resync;
  const bool near = surface_ ? command_ > *surface_ - config_.near_distance : target > command_;
  return near ? config_.speed_near : config_.speed_max;
}

/// Towards `target` as fast as speed and acceleration allow, braking in time.
void MotionGate::follow(double target, double dt) noexcept {
  if (std::abs(target - command_) <= config_.resync_distance) resynchronising_ = false;
  const AxisMotion next = step_axis({.command = command_, .velocity = velocity_},
                                    target,
                                    {.speed = speed_limit(target),
                                     .acceleration = config_.acceleration_max,
                                     .step_free = config_.step_free},
                                    dt);
  velocity_ = next.velocity;
  command_ = within_limits(next.command);
}

/// [N], of the law's limit and its own the lower one.
double MotionGate::force_most(const MotionRequest& request) const noexcept {
  return std::min(config_.force_limit, finite_or(request.force_most, config_.force_limit));
}

/// Where a tip that was braked may go: a little deeper at a time, until it is asked to go out.
double MotionGate::after_braking(double target, const MotionRequest& request) noexcept {
  if (within_limits(request.position) <= command_) braked_ = false;
  if (!braked_) return target;
  const double most = force_most(request);
  const bool rests = foresight_.bound(request.tip, most) >= request.tip;
  const double from = rests ? std::max(command_, request.tip) : command_;
  return std::min(target, from + foresight_.step_most(most));
}

/// A target that is too deep is taken back to the tip and behind it: only so a stage brakes at
/// once.
void MotionGate::brake(const MotionRequest& request, double dt) noexcept {
  const double tip = request.tip;
  const double deepest = std::max(foresight_.bound(tip, force_most(request)), config_.travel_min);
  if (command_ <= deepest) return;
  braked_ = true;
  command_ =
      std::max(deepest, std::min(command_, tip) - kRetreatGrowth * config_.retreat_speed * dt);
  velocity_ = 0;
}

/// Never inwards.
void MotionGate::move_out(double tip, double target, double speed, double dt) noexcept {
  const double from = std::min(command_, tip);
  command_ = std::min(from, std::max(target, from - speed * dt));
  command_ = std::max(command_, std::min(config_.travel_min, from));
  velocity_ = -speed;
  plane_.hold();
}

/// In the air as fast as the stage may; pressed, at the speed of a drag or not at all: what moves
/// faster would tear at the tissue.
void MotionGate::follow_place(const MotionRequest& request,
                              double dt,
                              MotionAnswer& answer) noexcept {
  const NoteCode refused = plane_.follow(request.place, !outside(request.tip), dt);
  if (refused != place_noted_) answer.place_note = refused;
  place_noted_ = answer.place_refused = refused;
}

/// Where the tip is out of the tissue, and away from where it felt the surface, none is known.
void MotionGate::leave_place(double tip) noexcept {
  if (surface_of_this_place_ && outside(tip) &&
      distance(plane_.command(), surface_place_) > kSamePlace) {
    surface_of_this_place_ = false;
  }
}

void MotionGate::note_once(MotionAnswer& answer, NoteCode code, double detail) noexcept {
  if (noted_ != code) {
    answer.note = code;
    answer.detail = detail;
  }
  noted_ = code;
}

MotionAnswer MotionGate::pass(const MotionRequest& request, const Lapse& lapse) noexcept {
  MotionAnswer answer;
  // What the process slept through, the stage has stood: a late tick buys no bigger step.
  const double span = seconds(lapse.period);
  NoteCode condition = NoteCode::None;
  const bool finite = std::isfinite(request.position);
  if (request.state == SiteState::Stopped) {
    hold();
    command_ = finite_or(request.tip, command_);
    // Whatever moved it meanwhile: after a reset it sets out from where it stands.
    if (is_finite(request.stands)) plane_.begin(request.stands);
    answer.halt = true;
  } else if (request.contact_force > config_.force_limit) {
    const double excess = request.contact_force - config_.force_limit;
    const double speed = config_.retreat_speed * std::min(kRetreatGrowth, 1 + 4 * excess);
    move_out(request.tip, config_.travel_min, speed, span);
    ceiling_.hit(command_);
    condition = NoteCode::ForceRetreat;
    note_once(answer, condition, request.contact_force);
  } else if (request.state == SiteState::Retract || request.state == SiteState::Parked) {
    if (retracted(request.tip) || (!surface_ && request.state == SiteState::Parked)) {
      hold();
    } else {
      // What is felt and never was taken for a contact is left all the same, until it is not felt.
      const double target = surface_ ? clear_position() : config_.travel_min;
      move_out(request.tip, target, config_.retract_speed, span);
    }
  } else if (request.state != SiteState::Engaged) {
    hold();
    brake(request, span);
  } else if (!finite) {
    hold();
    brake(request, span);
    condition = NoteCode::NotFinite;
    note_once(answer, condition, 0);
  } else {
    if (outside(request.tip)) ceiling_.forget();
    const double allowed = within_limits(request.position);
    const double target = ceiling_.bound(allowed, std::max(felt_, request.contact_force), span);
    if (allowed != request.position) {
      condition = NoteCode::MotionGateLimited;
      note_once(answer, condition, request.position);
    } else if (target != allowed) {
      condition = NoteCode::ForceRetreat;  // it was said when the retreat began
      noted_ = condition;
    }
    follow_place(request, span, answer);
    leave_place(request.tip);
    follow(after_braking(target, request), span);
    brake(request, span);
  }
  if (condition == NoteCode::None) noted_ = NoteCode::None;
  if (answer.place_refused == NoteCode::None) place_noted_ = NoteCode::None;
  answer.position = command_;
  answer.place = plane_.command();
  answer.acted = request.state == SiteState::Engaged && command_ != request.position;
  return answer;
}

}  // namespace palp::patient
