#include "common/coupling/mmt.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kEnergyTolerance = 1e-15;  // [J]
constexpr double kForceTolerance = 1e-12;   // [N]
constexpr double kOffWay = 0.03;            // [N], in all, so far a blend may stray
constexpr double kDeepest = 0.15;           // [m], a hand below a surface: both travel 60 mm
constexpr int kAttempts = 8;                // to let a force fall no faster than it may
constexpr int kHalvings = 30;

constexpr bool may_render(SiteState state) noexcept {
  return state == SiteState::Engaged || state == SiteState::Hold || state == SiteState::Retract;
}

/// A share of the way from one model to another.
ContactModel blended(ContactModel from, const ContactModel& to, double share) noexcept {
  from.surface += share * (to.surface - from.surface);
  from.reach += share * (to.reach - from.reach);
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    from.c[term] += share * (to.c[term] - from.c[term]);
  }
  for (std::size_t knot = 0; knot < kModelKnots.size(); ++knot) {
    from.stiffness[knot] += share * (to.stiffness[knot] - from.stiffness[knot]);
  }
  return from;
}

/// [m], where the force [N] is `wanted`; deeper than any tissue is told, along the tangent.
double depth_of(const ContactModel& model, double wanted) noexcept {
  const double beyond = wanted - model.force(kModelDepthMax);
  if (beyond <= 0) return model.depth(wanted);
  return kModelDepthMax + beyond / model.slope(kModelDepthMax);
}

/// The force at `position` [m] goes the same share of its way. Of two tissues whose surfaces are
/// far apart, what lies between by its numbers alone can be stiffer there than both; and of two
/// that reach differently deep, anywhere: nowhere is it steeper than `slope_max` [N/m].
ContactModel blended_at(double position,
                        const ContactModel& from,
                        const ContactModel& to,
                        double share,
                        double slope_max) noexcept {
  ContactModel between = no_steeper(blended(from, to, share), slope_max);
  const double before = from.force(position - from.surface);
  const double after = to.force(position - to.surface);
  const double wanted = before + share * (after - before);
  const double by_numbers = between.force(position - between.surface);
  if (before > 0 && after > 0 && std::abs(by_numbers - wanted) > kOffWay * share) {
    const double depth = depth_of(between, wanted);
    if (depth <= kDeepest) between.surface = position - depth;
  }
  return between;
}

RelaxingContact::Shares blended(RelaxingContact::Shares from,
                                const RelaxingContact::Shares& to,
                                double share) noexcept {
  for (std::size_t k = 0; k < from.size(); ++k) from[k] += share * (to[k] - from[k]);
  return from;
}

}  // namespace

MmtSurgeon::MmtSurgeon(const MmtConfig& config, const HandFacts& hand) noexcept
    : config_{config},
      device_{hand, config.velocity_cut_off},
      velocity_{device_.velocity_cut_off(), config.period},
      told_velocity_{config.lead_cut_off, config.period},
      tank_{config.tank},
      release_{at_device(config.release, hand)} {}

/// The axis may have moved under the hand, so there is no work in this tick. The tank is kept.
void MmtSurgeon::begin_epoch(double position) noexcept {
  drop_model();
  position_before_ = position;
  velocity_.reset();
  told_velocity_.reset(0);
  version_ = 0;
  presence_.set(1);
}

/// What is not shown stores nothing; the tank gets nothing for it.
void MmtSurgeon::drop_model() noexcept {
  showing_ = false;
  stored_ = 0;
  shown_force_ = 0;
  depth_ = 0;
  release_.end();
  brake_ = 0;
  ContactModel nothing = shown_.elastic();
  nothing.c = {};
  nothing.stiffness = {};
  shown_.become(nothing, {});
  shown_.forget();
}

/// Of a quick hand there, by the newest model.
double MmtSurgeon::told_force(double position) const noexcept {
  if (!candidate_) return 0;
  return quick_gain(candidate_relaxing_) *
         candidate_->force(position - candidate_->surface - swing_.after(swing_age_));
}

/// [m], where the hand would be with the force that is shown. In a tissue that was just met a light
/// hand is deeper than the tip ever was: what is told of there, and otherwise with each reading, is
/// a guess, and is not felt.
double MmtSurgeon::place_shown(double position) const noexcept {
  return position - std::max(0.0, depth_at(position) - depth_);
}

/// [N], at rest, what the told tissue has more than is shown of it at most.
double MmtSurgeon::too_stiff(double position) const noexcept {
  const double depth = position - told_.surface - swing_.after(swing_age_);
  return told_.force(depth) - device_.share() * candidate_.value_or(told_).force(depth);
}

void MmtSurgeon::hear(const SurgeonInput& in) noexcept {
  const Incoming* last = newest(in.arrived);
  if (last == nullptr) return;
  const auto* model = std::get_if<ModelPayload>(&last->sample.payload);
  if (model == nullptr || model->version < version_) return;
  if (!is_sound(*model, config_.travel)) {
    ++refused_;
    return;
  }
  version_ = model->version;
  if (model->version == 0) return;
  const double foreseen = swing_.after(swing_age_);
  swing_ = {model->swing, model->swing_quadrature, model->swing_rate};
  swing_age_ = 0.5 * seconds(in.round_trip);
  surface_contradiction_.tell(swing_.after(swing_age_) - foreseen);
  const double felt_at = place_shown(in.position);
  const double told = told_force(felt_at);
  told_ = contact_model(*model);
  candidate_ = no_steeper(told_, config_.slope_max / quick_gain(model->relaxing));
  candidate_relaxing_ = model->relaxing;
  force_contradiction_.tell(told_force(felt_at) - told);
}

/// The surface moves as its swing does, as fast as one that breathes may. A peer that tells of
/// other swings than it foresaw moves it less.
void MmtSurgeon::swing_shown(ContactModel& elastic, double span) noexcept {
  const double slower =
      surface_contradiction_.slower(config_.surface_believed, config_.surface_doubt);
  const double most = config_.surface_speed / slower * span;
  const double way = std::clamp(swing_.after(swing_age_) - swung_, -most, most);
  elastic.surface += way;
  swung_ += way;
}

/// The shown model ages at `depth` and moves towards the newest one; in the air at once, for
/// nothing is stored there. A force that falls falls no faster than `fall`: a lie is no kick, and
/// the tank pays, as for any change of the model.
void MmtSurgeon::approach_candidate(double position, double depth, const Lapse& lapse) noexcept {
  const double passed = seconds(lapse.passed());
  if (!candidate_) return shown_.age(depth, passed);
  ContactModel aim = *candidate_;
  const double given = presence_.value() * device_.share();
  for (double& coefficient : aim.c) coefficient *= given;
  for (double& stiffness : aim.stiffness) stiffness *= given;
  // The surface swings on by itself; what is blended is the rest.
  ContactModel elastic = shown_.elastic();
  const double swung = swing_.after(swing_age_);
  if (!showing_ || (depth <= 0 && position <= aim.surface + swung)) {
    aim.surface += swung;
    swung_ = swung;
    shown_.age_into(aim, candidate_relaxing_, depth, passed);
    showing_ = true;
    return;
  }
  swing_shown(elastic, passed);
  // Of no tissue the surface is nowhere.
  aim.surface = aim.force(kModelDepthMax) > 0 ? aim.surface + swung_ : elastic.surface;
  const RelaxingContact before = shown_;
  const double force = before.force(depth);
  const double fall_max = config_.fall * seconds(lapse.period);
  const double slower =
      std::min(config_.slowest, force_contradiction_.slower(config_.believed, config_.doubt));
  const double blend = config_.blend * slower;
  double share = -std::expm1(-seconds(lapse.period) / blend);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const auto relaxing = blended(before.relaxing(), candidate_relaxing_, share);
    const double slope_max = config_.slope_max / quick_gain(relaxing);
    const ContactModel between = blended_at(position, elastic, aim, share, slope_max);
    shown_ = before;
    shown_.age_into(between, relaxing, depth, passed);
    const double fall = force - shown_.force(std::min(depth, position - between.surface));
    if (fall <= fall_max) return;
    // A surface that goes far lets go of all at once, however little of its way is gone.
    share *= std::min(0.95 * fall_max / fall, attempt < kAttempts / 2 ? 1 : 0.1);
  }
  // But for its swing it stays as it was.
  shown_ = before;
  shown_.age_into(elastic, before.relaxing(), depth, passed);
}

/// The hand moved, the model did not.
void MmtSurgeon::give_way(double moved) noexcept {
  depth_ += moved;
  release_.move(moved);
}

double MmtSurgeon::force_now() const noexcept {
  return release_.holds() ? release_.force() : shown_.force(depth_);
}

/// What the hand could take as it lets the force push it out.
double MmtSurgeon::energy_now() const noexcept {
  return release_.holds() ? release_.energy() : shown_.energy(depth_);
}

/// The greatest depth with which energy and force stay below their limits. Holding a force takes no
/// energy, giving way does: where the tank cannot pay for the model's own spring, the force is
/// shown all the same and lets go along a steeper line, which stores less.
void MmtSurgeon::choose_depth(double position, double energy_max, double force_max) noexcept {
  const double whole = depth_at(position);
  const auto fits = [&](double depth) {
    const double force = shown_.force(depth);
    return force <= force_max + kForceTolerance &&
           std::min(shown_.energy(depth), release_.least(force)) <= energy_max + kEnergyTolerance;
  };
  depth_ = whole;
  if (whole > 0 && !fits(whole)) {
    double low = 0;
    double high = whole;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (fits(middle) ? low : high) = middle;
    }
    depth_ = low;
  }
  if (shown_.energy(depth_) > energy_max + kEnergyTolerance) {
    release_.hold(shown_.force(depth_), energy_max);
  } else {
    release_.end();
  }
}

/// How fast a new model may come in under a hand on its way in. A large force that appears under a
/// light hand throws it back.
double MmtSurgeon::slew_for(double position, Duration round_trip) const noexcept {
  const double there = candidate_ ? candidate_->force(position - candidate_->surface) : 0;
  const double missing = std::max(there, shown_.force(depth_at(position))) - shown_force_;
  const double room = (config_.gap_large - missing) / (config_.gap_large - config_.gap_small);
  const double small =
      round_trip < config_.round_trip_short ? config_.slew_short : config_.slew_small;
  return config_.slew + (small - config_.slew) * std::clamp(room, 0.0, 1.0);
}

/// A hand that runs into tissue not shown yet is stopped by more than this, or it goes in too far;
/// by a spring alone, it would be thrown back and come in a second time.
void MmtSurgeon::brake(double missing, double speed, double rise_max) noexcept {
  brake_ =
      std::min({std::max(0.0, missing), config_.brake * std::max(0.0, speed), brake_ + rise_max});
}

/// How much the tank lacks, 0 to 1.
double MmtSurgeon::debt() const noexcept { return std::clamp(1 - tank_ / config_.tank, 0.0, 1.0); }

/// In the air and on the way out of the tissue the hand pays the tank back: on the way in, where
/// stiffness is judged, damping would be felt as softness.
double MmtSurgeon::damp(double force, double depth, double speed) const noexcept {
  const double empty = config_.empty_damping * std::clamp(-tank_ / config_.overdraft, 0.0, 1.0);
  if (depth > 0) {
    const double damping = config_.contact_damping + config_.repay_contact * debt();
    force = std::max(0.0, force + std::min(damping, device_.damping_most()) * std::min(0.0, speed));
  } else {
    force +=
        std::min(config_.air_damping + config_.repay_air * debt(), device_.damping_most()) * speed;
  }
  force += std::min(empty, device_.damping_most()) * speed;
  return force;
}

/// Behind the closing gate a force still fades. Held up while a hand is snatched away it would give
/// more than was ever pressed into the spring; so the spring stays, as it was left, until the force
/// is gone: it limits the fade, and what it stored pays for it.
SurgeonOutput MmtSurgeon::let_go(const SurgeonInput& in, double work) noexcept {
  const double paid = std::clamp(-work, 0.0, stored_);
  stored_ -= paid;
  tank_ = std::min(config_.tank, tank_ + work + paid);
  if (in.force_applied == 0) drop_model();
  // A hand that was let out under a force held too long has taken of this already.
  const double left = std::max(0.0, stored_ + tank_);
  if (energy_now() > left) choose_depth(in.position, left, force_now());
  shown_force_ = force_now();
  return {0, {in.position, told_velocity_.value(), 0, std::monostate{}}, shown_force_};
}

SurgeonOutput MmtSurgeon::step(const SurgeonInput& in, const Lapse& lapse) noexcept {
  const double span = seconds(lapse.period);
  swing_age_ += seconds(lapse.passed());
  force_contradiction_.age(seconds(lapse.passed()));
  surface_contradiction_.age(seconds(lapse.passed()));
  hear(in);
  const double speed = velocity_.step(in.position, lapse.periods);
  // The tip runs ahead by it. Steps of an encoder cancel in it before some of them are lost.
  told_velocity_.step(in.velocity, lapse.periods);
  const double work = in.force_applied * (in.position - position_before_);
  give_way(in.position - position_before_);
  position_before_ = in.position;

  if (!may_render(in.state)) return let_go(in, work);
  if (in.state == SiteState::Retract) presence_.fall(span, config_.fade);

  const double depth_before = depth_;
  const double moved = energy_now();
  const double force_before = force_now();
  tank_ = std::min(config_.tank, tank_ + work - (moved - stored_));
  device_.look(in.position, force_before > 0, tank_, seconds(lapse.passed()));

  approach_candidate(in.position, depth_before, lapse);
  const double rise_max = slew_for(in.position, in.round_trip) * span;
  // As a hand stops less and less comes in: what stops it must not push it back.
  const double moving = std::clamp(config_.slew_rest + speed / config_.slew_speed, 0.0, 1.0);
  const double force_max =
      std::max(force_before + config_.slew_beside * span, shown_force_ + moving * rise_max);
  choose_depth(in.position, std::max(0.0, moved + tank_), force_max);
  stored_ = energy_now();
  tank_ -= stored_ - moved;

  shown_force_ = shown_.force(depth_);
  const double risen = std::max(0.0, shown_force_ - force_before);
  brake(shown_.force(depth_at(in.position)) - shown_force_, speed, std::max(0.0, rise_max - risen));
  const double force = damp(shown_force_, depth_, speed) + brake_;
  return {force,
          {in.position, told_velocity_.value(), force, std::monostate{}},
          shown_force_,
          std::max(0.0, shown_.force(depth_at(in.position)) - shown_force_),
          std::max(0.0, too_stiff(in.position))};
}

}  // namespace palp::coupling
