#include "common/coupling/contact_estimator.h"

#include <algorithm>
#include <cmath>

#include "common/coupling/contact_model.h"

namespace palp::coupling {
namespace {

constexpr double kPullMost = 5;        // [-], of the elastic force
constexpr double kGridStep = 0.05e-3;  // [m]
constexpr std::size_t kMiddle = 32;
constexpr std::uint32_t kBox = 5;            // ticks per equation: what the pole lets through
constexpr double kMisplaced = 2e-3;          // [m], below the surface as believed, and nothing felt
constexpr double kMisfit = 3e-3;             // [N], of an equation: no tissue is of these shapes
constexpr std::uint32_t kForgetShapes = 60;  // ticks until the filtered shapes are zero again
constexpr double kFullSpeed = 2e-3;          // [m/s], of the tip: below it data repeat themselves
constexpr double kBreathSpeed = 10e-3;       // [m/s], the same where the surface breathes
constexpr double kBreathWeightMin = 0.4;     // [-], and what is too slow to say anything there
constexpr double kStillWeight = 0.05;        // [-], of an equation that repeats the last one
constexpr double kOutwardWeight = 0.5;       // [-], of one on the way out: the way in is judged
constexpr std::uint32_t kDoubtTicks = 60;    // after the first contact
constexpr double kDoubtShare = 0.25;         // [-], of the force that counts as contact
constexpr double kDoubtRetreat = 0.1e-3;     // [m], a tip that went farther out says nothing
constexpr std::size_t kNeighbours = 4;       // candidates around the best that are always judged
constexpr std::size_t kStride = 12;          // of the others, one in so many
constexpr std::size_t kEdge = 3;             // so near the grid's end it is moved
constexpr double kSplineAbove = 2e-3;        // [m], over the grid's middle: where it begins
constexpr std::uint32_t kSplineEvery = 4;    // equations
constexpr double kAstray = 3e-3;             // [m], a surface above where the tip felt nothing
constexpr std::int64_t kFollowed = 64;       // periods, in which all that is short settles

}  // namespace

ContactEstimator::ContactEstimator(const ContactEstimatorConfig& config) noexcept
    : config_{config},
      gain_{LowPass{config.sensor.pole, config.period}.gain()},
      onset_{config.detection_force, config.sensor, config.period},
      sensed_{.tip = {config.sensor.pole, config.period}},
      told_{HeldForce{config.period}, SurfaceDrift{config.period}},
      swing_{config.period} {
  expected_.c[1] = config.stiffness_expected * kModelDepthScale * std::sqrt(kModelDepthScale);
  here_.expected = expected_.c;
}

double ContactEstimator::surface_of(std::size_t candidate) const noexcept {
  return centre_ + kGridStep * (static_cast<double>(candidate) - static_cast<double>(kMiddle));
}

void ContactEstimator::place_grid(double centre) noexcept {
  centre_ = centre;
  for (Lane& lane : right_) lane.fill(0);
  for (Lane& lane : box_.terms) lane.fill(0);
  for (Lane& lane : normal_) lane.fill(0);
  spline_.begin(centre - kSplineAbove, sensed_.tip.value());
  sums_.square = sums_.weight = 0;
  box_.force = 0;
  box_.count = 0;
  box_.tip = sensed_.tip.value();
  for (std::size_t i = 0; i < kCandidates; ++i) {
    const double xi = std::max(0.0, sensed_.tip.value() - surface_of(i)) / kModelDepthScale;
    const auto shapes = model_shapes(xi);
    for (std::size_t term = 0; term < kModelTerms; ++term) shapes_[term][i] = shapes[term];
    found_[i] = expected_.c;
  }
  best_ = kMiddle;
  expected_.surface = centre;
  placed_ = true;
}

/// A wrong breath and a wrong tissue confirm each other, and the surface walks away. Then both are
/// forgotten. Where no breath is believed yet, one may be why it walks.
void ContactEstimator::begin_again() noexcept {
  if (model_.swing_rate > 0) swing_ = BreathingEstimator{config_.period};
  expected_ = {.c = here_.expected};
  sensed_.tip.reset(sensed_.raw_tip);
  sensed_.tip_mean = sensed_.raw_tip_mean;
  ContactModel believed{0, {}, kModelDepthMax};
  std::copy_n(expected_.c.begin(), kModelTerms, believed.c.begin());
  place_grid(sensed_.tip_mean - believed.depth(sensed_.force_mean));
}

/// There is no tissue here: what passed for a contact was noise, or the tissue is elsewhere.
void ContactEstimator::withdraw() noexcept {
  placed_ = here_.contact = false;
  doubt_.ticks = 0;
  expected_ = {.c = here_.expected};
  ++model_.version;
  model_.c = {};
  model_.stiffness = {};
  model_.relaxing = {};
}

void ContactEstimator::filter_shapes(double position) noexcept {
  const double lowest = surface_of(0);
  if (position <= lowest) {
    if (ticks_outside_ >= kForgetShapes) return;
    if (++ticks_outside_ == kForgetShapes) {
      for (Lane& lane : shapes_) lane.fill(0);
      return;
    }
  } else {
    ticks_outside_ = 0;
  }
  const double scaled = (position - lowest) / kModelDepthScale;
  constexpr double kStep = kGridStep / kModelDepthScale;
  constexpr double kUnbend = 1 / kModelBend;
  for (std::size_t i = 0; i < kCandidates; ++i) {
    const double xi = std::max(0.0, scaled - kStep * static_cast<double>(static_cast<int>(i)));
    const double square = xi * xi;
    const double cube = square * xi;
    const double bent = xi * std::sqrt(xi / (1 + xi * kUnbend));
    shapes_[0][i] += gain_ * (xi - shapes_[0][i]);
    shapes_[1][i] += gain_ * (bent - shapes_[1][i]);
    shapes_[2][i] += gain_ * (square - shapes_[2][i]);
    shapes_[3][i] += gain_ * (cube - shapes_[3][i]);
    shapes_[4][i] += gain_ * (cube * square - shapes_[4][i]);
  }
}

double ContactEstimator::elastic() const noexcept {
  double force = 0;
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    force += found_[best_][term] * shapes_[term][best_];
  }
  return force;
}

/// What lags is seen through the best model so far: it is a small part of the force, and that model
/// becomes better.
void ContactEstimator::relax() noexcept {
  const double now = elastic();
  for (std::size_t k = 0; k < beside_.past.size(); ++k) {
    beside_.past[k] += config_.period / kModelTimes[k] * (now - beside_.past[k]);
    // Tissue does not pull.
    beside_.terms[k] = std::max(now - beside_.past[k], -kPullMost * now);
  }
  beside_.terms.back() = now * sensed_.tip_speed;
}

double ContactEstimator::predicted() const noexcept {
  double force = elastic();
  for (std::size_t k = 0; k < beside_.terms.size(); ++k) {
    force += found_[best_][kModelTerms + k] * beside_.terms[k];
  }
  return force;
}

void ContactEstimator::collect(double force) noexcept {
  if (ticks_outside_ >= kForgetShapes) {
    box_.count = 0;
    return;
  }
  if (box_.count == 0) {
    for (Lane& lane : box_.terms) lane.fill(0);
    box_.force = 0;
    spline_.begin_equation();
  }
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    for (std::size_t i = 0; i < kCandidates; ++i) box_.terms[term][i] += shapes_[term][i];
  }
  for (std::size_t k = 0; k < beside_.terms.size(); ++k) {
    for (double& sum : box_.terms[kModelTerms + k]) sum += beside_.terms[k];
  }
  box_.force += force - (model_.version > 0 ? noise_.bias(predicted(), config_.sensor.step) : 0);
  if (++box_.count < kBox) return;
  box_.count = 0;
  absorb();
  search();
}

/// [N^2], of the mean over a box.
double ContactEstimator::equation_noise() const noexcept {
  const double step = config_.sensor.step;
  return std::max(std::max(noise_.mean_square(), step * step / 12) / kBox, kMisfit * kMisfit);
}

void ContactEstimator::absorb() noexcept {
  const double inward = sensed_.tip.value() - box_.tip;
  const double travelled = std::abs(inward);
  box_.tip = sensed_.tip.value();
  // A tip that stands still in a breathing tissue sees stiffness times motion of the surface, and
  // cannot tell a soft tissue that moves much from a stiff one that moves little: motion can.
  const bool breathes = model_.swing_rate > 0;
  const double full = (breathes ? kBreathSpeed : kFullSpeed) * config_.period * kBox;
  double weight = std::clamp(travelled / full, breathes ? 0.0 : kStillWeight, 1.0);
  if (breathes && weight < kBreathWeightMin) return;
  // Whatever makes the way out another one than the way in, and is not among the terms: a finger
  // judges stiffness on the way in.
  if (inward < 0) weight *= kOutwardWeight;
  const double keep = 1 - weight * config_.period * kBox / config_.memory;
  const double scale = 1.0 / kBox;
  const double force = box_.force * scale;
  for (Lane& lane : box_.terms) {
    for (double& shape : lane) shape *= scale;
  }
  SplineEstimator::Met met{force};
  for (std::size_t k = 0; k < SplineEstimator::kBeside; ++k) {
    met[1 + k] = box_.terms[kModelTerms + k][best_];
  }
  spline_.add(met, weight, keep);
  sums_.square = keep * sums_.square + weight * force * force;
  sums_.weight = keep * sums_.weight + weight;
  std::size_t at = 0;
  for (std::size_t row = 0; row < kTerms; ++row) {
    for (std::size_t column = row; column < kTerms; ++column, ++at) {
      for (std::size_t i = 0; i < kCandidates; ++i) {
        normal_[at][i] =
            keep * normal_[at][i] + weight * box_.terms[row][i] * box_.terms[column][i];
      }
    }
    for (std::size_t i = 0; i < kCandidates; ++i) {
      right_[row][i] = keep * right_[row][i] + weight * force * box_.terms[row][i];
    }
  }
}

void ContactEstimator::search() noexcept {
  const std::size_t from = best_ > kNeighbours ? best_ - kNeighbours : 0;
  const std::size_t to = std::min(best_ + kNeighbours, kCandidates - 1);
  Solution winner = solve(best_, swing_.still());
  std::size_t won = best_;
  const auto judge = [&](std::size_t candidate) {
    const Solution solution = solve(candidate, swing_.still());
    if (solution.cost < winner.cost) {
      winner = solution;
      won = candidate;
    }
  };
  for (std::size_t i = from; i <= to; ++i) {
    if (i != best_) judge(i);
  }
  for (std::size_t i = turn_ % kStride; i < kCandidates; i += kStride) {
    if (i < from || i > to) judge(i);
  }
  ++turn_;
  best_ = won;
  if (turn_ % kSplineEvery == 0) fit_spline(winner);
  publish(winner);
  const double swings = std::hypot(model_.swing, model_.swing_quadrature);
  if (surface_of(best_) + swings < here_.deepest_in_air - kAstray) return begin_again();
  if (best_ < kEdge || best_ + kEdge >= kCandidates) {
    expected_.c = winner.c;
    const KnotStiffness stiffness = spline_.stiffness();
    const double share = spline_.share();
    place_grid(surface_of(best_));
    spline_.expect(stiffness, share);
  }
}

void ContactEstimator::publish(const Solution& solution) noexcept {
  ++model_.version;
  std::copy_n(solution.c.begin(), kModelTerms, model_.c.begin());
  std::copy_n(solution.c.begin() + kModelTerms, model_.relaxing.size(), model_.relaxing.begin());
  for (double& coefficient : model_.c) coefficient *= 1 - spline_.share();
  model_.stiffness = spline_.stiffness();
  for (double& stiffness : model_.stiffness) stiffness *= spline_.share();
  model_.surface = surface_of(best_);
  told_.breathe(swing_.believed());
  if (told_.breathes) {
    // What was found together with the swing: the rest was learned before it was known.
    model_.c = {};
    model_.stiffness = {};
    const auto shapes = swing_.shapes();
    std::copy(shapes.begin(), shapes.end(), model_.c.begin() + 1);
    model_.relaxing = swing_.relaxing();
    model_.surface = swing_.surface();
  }
  model_.depth_max = std::max(0.0, here_.deepest - model_.surface);
}

void ContactEstimator::track(double position) noexcept {
  sensed_.raw_tip += gain_ * (position - sensed_.raw_tip);
  sensed_.raw_tip_mean += kMeanGain * (sensed_.raw_tip - sensed_.raw_tip_mean);
}

/// Where the surface must be for the present force: depth and force through the same filters.
void ContactEstimator::watch_surface() noexcept {
  swing_.step();
  if (model_.version == 0) return;
  swing_.see(sensed_.raw_tip_mean, sensed_.force_mean);
}

double ContactEstimator::sense(double position, double force) noexcept {
  if (!sensed_.started) {
    sensed_.raw_tip = sensed_.raw_tip_mean = position;
    sensed_.started = true;
    sensed_.position_before = position;
    sensed_.force_before = force;
    sensed_.tip.reset(position);
    sensed_.tip_mean = position;
  }
  // The transducer's pole acted all through the period: the tip was half-way on average.
  const double moving = 0.5 * (position + sensed_.position_before);
  sensed_.position_before = position;
  sensed_.force_before = force;
  const Swing swing = swing_.swing();
  model_.swing = swing.now;
  model_.swing_quadrature = swing.quadrature;
  model_.swing_rate = swing.rate;
  const double halfway = moving - swing.now;  // as if the surface stood still
  const double tip_before = sensed_.tip.value();
  sensed_.tip.step(halfway);
  sensed_.tip_speed = (sensed_.tip.value() - tip_before) / config_.period;
  sensed_.force_mean += kMeanGain * (force - sensed_.force_mean);
  sensed_.tip_mean += kMeanGain * (sensed_.tip.value() - sensed_.tip_mean);

  track(moving);
  return halfway;
}

/// What filters would have seen of periods in which nobody looked: an even way to where the tip is
/// now. No such reading becomes an equation, or says where a surface is.
void ContactEstimator::follow(double position, double force, std::int64_t periods) noexcept {
  const std::int64_t followed = std::min(periods, kFollowed);
  swing_.pass_unseen(static_cast<double>(periods) * config_.period);
  const double unseen = static_cast<double>(periods - followed) * config_.period;
  for (std::size_t k = 0; k < beside_.past.size(); ++k) {
    beside_.past[k] -= std::expm1(-unseen / kModelTimes[k]) * (elastic() - beside_.past[k]);
  }
  const double position_step =
      (position - sensed_.position_before) / static_cast<double>(followed + 1);
  const double force_step = (force - sensed_.force_before) / static_cast<double>(followed + 1);
  for (std::int64_t i = 0; i < followed; ++i) {
    const double halfway =
        sense(sensed_.position_before + position_step, sensed_.force_before + force_step);
    if (!placed_) continue;
    filter_shapes(halfway);
    spline_.follow(halfway, gain_);
    relax();
  }
}

/// `threshold` [N]: from here on a mean force counts as contact.
void ContactEstimator::doubt(double threshold) noexcept {
  if (doubt_.ticks == 0) return;
  --doubt_.ticks;
  if (sensed_.tip.value() < doubt_.tip - kDoubtRetreat) doubt_.ticks = 0;
  if (doubt_.ticks > 0 && sensed_.force_mean < kDoubtShare * threshold) withdraw();
}

void ContactEstimator::begin_contact() noexcept {
  noise_.settle(config_.sensor.step);
  const double depth = std::cbrt(std::pow(sensed_.force_mean / config_.stiffness_expected, 2));
  place_grid(sensed_.tip_mean - depth);
  Solution prior;
  prior.c = expected_.c;
  here_.deepest = sensed_.tip_mean;
  doubt_.tip = sensed_.tip.value();
  doubt_.ticks = kDoubtTicks;
  publish(prior);
}

void ContactEstimator::look(double halfway, double force) noexcept {
  const double threshold = onset_.force(noise_.deviation());
  const bool contact = sensed_.force_mean >= threshold && noise_.known();
  if (placed_ && !contact && sensed_.tip.value() > centre_ + kMisplaced) withdraw();
  doubt(threshold);
  if (!placed_) {
    if (!contact) return noise_.listen(force);  // before the first contact every reading is noise
    begin_contact();
  }
  if (!contact && here_.contact)
    here_.deepest_in_air = std::max(here_.deepest_in_air, sensed_.raw_tip);
  if (contact) {
    here_.contact = true;
    here_.touched += config_.period;
    here_.deepest = std::max(here_.deepest, sensed_.tip.value());
  }
  filter_shapes(halfway);
  spline_.follow(halfway, gain_);
  relax();
  collect(force);
  if (model_.version > 0) model_.residual = force - predicted();
  follow_told(force - noise_.bias(told_.held.force(), config_.sensor.step), contact);
}

/// What is told is compared with the `force` [N] of a tip that rests or is slow. A surface that may
/// move does; one that is known to stand still has a tissue that relaxes.
void ContactEstimator::follow_told(double force, bool touches) noexcept {
  const ModelPayload moved = told_.drift.moved(model_);
  told_.held.step(moved, sensed_.raw_tip, force, noise_.doubt());
  if (swing_.still()) {
    told_.drift.fade();
  } else {
    told_.drift.step(moved,
                     {sensed_.raw_tip, told_.held.speed(), force, told_.held.force(), touches});
  }
}

void ContactEstimator::step(double position, double force, std::int64_t periods) noexcept {
  if (periods > 1 && sensed_.started) follow(position, force, periods - 1);
  const double halfway = sense(position, force);
  watch_surface();
  look(halfway, force);
  told_.held.tell(told_.drift.moved(model_));
}

}  // namespace palp::coupling
