#include "common/coupling/breathing_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/coupling/contact_model.h"
#include "common/message/port_sample.h"

namespace palp::coupling {
namespace {

using std::numbers::pi;

// Breaths from 6 to 36 a minute.
constexpr double kSlowest = 2 * pi * 0.10;  // [rad/s]
constexpr double kFastest = 2 * pi * 0.60;  // [rad/s]
// A short arc fits many paces: an adult at rest breathes 12 to 20 times a minute.
constexpr double kUsual = 2 * pi * 0.26;     // [rad/s]
constexpr double kUnusual = 8;               // [-], cost of an octave
constexpr double kSeenFor = 4;               // [s], since the first sight, to believe a breath
constexpr double kStillSeenFor = 2;          // [s], to believe that there is none
constexpr std::size_t kSamplesMin = 30;      // to say anything
constexpr double kAmplitudeMin = 0.2e-3;     // [m]
constexpr double kStillBelow = 0.35e-3;      // [m]
constexpr double kStillBelowSoon = 0.2e-3;   // [m], before a breath can be believed
constexpr double kAmplitudeMax = 4e-3;       // [m]
constexpr double kExplainedMin = 0.6;        // [-], to begin believing
constexpr double kClearly = 0.5;             // [-], of what a tissue at rest leaves, to begin
constexpr double kExplainedLeast = 0.3;      // [-], to go on
constexpr double kPresenceTime = 0.3;        // [s]
constexpr double kContact = 0.03;            // [N]
constexpr double kAfterContact = 0.05;       // [s]
constexpr double kSampleEvery = 0.08;        // [s]
constexpr double kSampleSoonest = 0.025;     // [s], where the tip moves
constexpr double kSampleDistance = 0.15e-3;  // [m]
constexpr int kSamplesATick = 10;
constexpr int kSamplesATickStill = 4;  // once the surface is known to stand still
constexpr std::uint32_t kRounds = 12;  // through all samples, after the newest of them
constexpr double kNoise = 8e-3;        // [N], of a sample, with what no such tissue explains,
constexpr double kNoiseShare = 0.05;   // [-], and of the force: paces are judged by both, tissue by
                                       // the first, or it would be found too soft
constexpr double kDamped = 0.02;       // [-], of Marquardt
constexpr double kFloor = 1e-9;        // [N^2], so that no unknown is without an equation
constexpr double kStepMax = 0.5;       // [mm], of one improvement
// What is expected before the data, and how closely.
constexpr std::array<double, BreathingEstimator::kShapes> kShapeExpected{0.06, 0, 0};     // [N]
constexpr std::array<double, BreathingEstimator::kShapes> kShapeSpread{0.1, 0.05, 0.02};  // [N]
constexpr double kRelaxingSpread = 0.1;                                                   // [-]
constexpr double kSwingSpread = 0.8;                                                      // [mm]
constexpr std::size_t kSurface = BreathingEstimator::kShapes;
constexpr std::size_t kRelaxes = kSurface + 1;
constexpr std::size_t kCosine = kRelaxes + BreathingEstimator::kTimes;
constexpr std::size_t kSine = kCosine + 1;
constexpr std::size_t kRate = kCosine + 2;

/// The shapes [-] at a depth [-] and their slopes [1/mm].
struct Shaped {
  std::array<double, BreathingEstimator::kShapes> value{};
  std::array<double, BreathingEstimator::kShapes> slope{};
};
Shaped shaped(double xi) noexcept {
  const double bend = 1 + xi / kModelBend;
  const double root = std::sqrt(xi / bend);
  return {{xi * root, xi * xi, xi * xi * xi},
          {root * (1.5 - 0.5 * xi / (kModelBend * bend)), 2 * xi, 3 * xi * xi}};
}

double rate_of(double pace) noexcept {
  return kSlowest *
         std::pow(kFastest / kSlowest, pace / static_cast<double>(BreathingEstimator::kPaces));
}

}  // namespace

double Swing::after(double span) const noexcept {
  return now * std::cos(rate * span) + quadrature * std::sin(rate * span);
}

BreathingEstimator::BreathingEstimator(double period) noexcept : period_{period} {
  for (std::size_t i = 0; i < guesses_.size(); ++i) {
    Guess& guess = guesses_[i];
    guess.here.shape = guess.before.shape = kShapeExpected;
    guess.rate = i == 0 ? 0 : rate_of(static_cast<double>(i) - 0.5);
  }
}

void BreathingEstimator::step() noexcept {
  time_ += period_;
  const double step = period_ / kPresenceTime;
  presence_ = std::clamp(presence_ + (believed_ ? step : -step), 0.0, 1.0);
  fit_some();
}

/// The oldest place of three is forgotten; of the last its tissue is taken as it was found.
void BreathingEstimator::new_place() noexcept {
  if (!touched_) return;
  ++place_;
  touched_ = false;
  contact_at_ = -1;
  here_ = 0;
  for (Guess& guess : guesses_) guess.before = guess.here;
  at_guess_ = at_sample_ = 0;
  equations_ = {};
}

void BreathingEstimator::see(double position, double force) noexcept {
  for (std::size_t k = 0; k < kTimes; ++k)
    past_[k] += period_ / kModelTimes[k] * (force - past_[k]);
  if (force >= kContact) contact_at_ = time_;
  if (contact_at_ < 0 || time_ - contact_at_ > kAfterContact) return;
  if (first_seen_ < 0) first_seen_ = time_;
  if (!touched_) {
    touched_ = true;
    for (Guess& guess : guesses_) {
      const double tau = time_ - guess.origin;
      const double swing =
          guess.cosine * std::cos(guess.rate * tau) + guess.sine * std::sin(guess.rate * tau);
      const double depth = std::pow(force / std::max(0.01, guess.here.shape[0]), 2.0 / 3);
      guess.here.surface = position - swing - kModelDepthScale * std::min(depth, 2.0);
    }
  } else if (count_ > 0) {
    const Sample& last = samples_[(next_ + kSamples - 1) % kSamples];
    const double least =
        std::abs(position - last.position) > kSampleDistance ? kSampleSoonest : kSampleEvery;
    if (time_ - last.at < least) return;
  }
  samples_[next_] = {time_, position, force, past_, place_};
  next_ = (next_ + 1) % kSamples;
  count_ = std::min(count_ + 1, kSamples);
  ++here_;
  rounds_ = kRounds;
}

/// Goes on where it stopped: through all samples with one guess, then with the next.
void BreathingEstimator::fit_some() noexcept {
  if (rounds_ == 0) return;
  for (int i = still_ ? kSamplesATickStill : kSamplesATick; i > 0; --i) {
    if (at_sample_ >= count_) {
      improve(guesses_[at_guess_], at_guess_);
      equations_ = {};
      at_sample_ = 0;
      if (++at_guess_ < guesses_.size()) return;
      at_guess_ = 0;
      --rounds_;
      judge();
      return;
    }
    const Sample& sample = samples_[at_sample_++];
    if (sample.place + 1 >= place_) add(guesses_[at_guess_], sample);
  }
}

void BreathingEstimator::add(const Guess& guess, const Sample& sample) noexcept {
  const bool here = sample.place == place_;
  const Tissue& tissue = here ? guess.here : guess.before;
  const double tau = sample.at - guess.origin;
  const double c = std::cos(guess.rate * tau);
  const double s = std::sin(guess.rate * tau);
  const double swing = guess.cosine * c + guess.sine * s;
  const double depth = (sample.position - tissue.surface - swing) / kModelDepthScale;
  equations_.count += 1;
  equations_.time += sample.at;
  const double off = kNoiseShare * sample.force / kNoise;
  const double weight = 1 / (1 + off * off);
  if (depth <= 0) {
    equations_.square += weight * sample.force * sample.force;
    return;
  }
  const Shaped shape = shaped(depth);
  double force = 0;
  double slope = 0;  // [N/mm]
  for (std::size_t j = 0; j < kShapes; ++j) {
    force += tissue.shape[j] * shape.value[j];
    slope += tissue.shape[j] * shape.slope[j];
  }
  for (std::size_t k = 0; k < kTimes; ++k) force -= tissue.relaxing[k] * sample.past[k];
  const double left = sample.force - force;
  equations_.square += weight * left * left;
  std::array<double, kUnknowns> row{};
  if (here) {
    for (std::size_t j = 0; j < kShapes; ++j) row[j] = shape.value[j];
    row[kSurface] = -slope;
    for (std::size_t k = 0; k < kTimes; ++k) row[kRelaxes + k] = -sample.past[k];
  }
  row[kCosine] = -slope * c;
  row[kSine] = -slope * s;
  row[kRate] = -slope * tau * (guess.sine * c - guess.cosine * s) / kModelDepthScale;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    equations_.system.right[i] += row[i] * left;
    for (std::size_t j = 0; j <= i; ++j) equations_.system.matrix[i][j] += row[i] * row[j];
  }
}

/// The step over the unknowns that are open, damped; none if the equations leave one of them so.
std::array<double, BreathingEstimator::kUnknowns> BreathingEstimator::solved(
    const std::array<bool, kUnknowns>& open) const noexcept {
  SmallSystem<kUnknowns> damped = equations_.system;
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    damped.matrix[i][i] = damped.matrix[i][i] * (1 + kDamped) + kFloor;
  }
  return solve(damped, open).x;
}

/// Pace and phase part best where the phase counts from the middle of the samples: `origin` [s].
void BreathingEstimator::count_from(double origin, Guess& guess) noexcept {
  const double turned = guess.rate * (origin - guess.origin);
  const double c = std::cos(turned);
  const double s = std::sin(turned);
  const double cosine = guess.cosine * c + guess.sine * s;
  guess.sine = guess.sine * c - guess.cosine * s;
  guess.cosine = cosine;
  guess.origin = origin;
}

void BreathingEstimator::improve(Guess& guess, std::size_t pace) noexcept {
  Equations& e = equations_;
  if (e.count < 1) return;
  constexpr double kVariance = kNoise * kNoise;
  guess.square = e.square / e.count;
  guess.cost = e.square / kVariance;
  const bool swings = pace > 0;
  const auto expect = [&](std::size_t unknown, double value, double expected, double spread) {
    const double off = (value - expected) / spread;
    guess.cost += off * off;
    e.system.matrix[unknown][unknown] += kVariance / (spread * spread);
    e.system.right[unknown] -= kVariance * off / spread;
  };
  for (std::size_t j = 0; j < kShapes; ++j) {
    expect(j, guess.here.shape[j], kShapeExpected[j], kShapeSpread[j]);
  }
  for (std::size_t k = 0; k < kTimes; ++k) {
    expect(kRelaxes + k, guess.here.relaxing[k], 0, kRelaxingSpread);
  }
  const double middle = rate_of(static_cast<double>(pace) - 0.5);
  if (swings) {
    expect(kCosine, guess.cosine / kModelDepthScale, 0, kSwingSpread);
    expect(kSine, guess.sine / kModelDepthScale, 0, kSwingSpread);
    expect(kRate, guess.rate, middle, 0.1 * middle);
    const double octaves = std::log2(guess.rate / kUsual);
    guess.cost += kUnusual * octaves * octaves;
  }
  // What is 0 and would become negative, and what a surface at rest has not, stays out.
  std::array<bool, kUnknowns> open{};
  for (std::size_t i = 0; i < (swings ? kUnknowns : kCosine); ++i) {
    const bool share = i >= kRelaxes && i < kCosine;
    const double now = i < kShapes ? guess.here.shape[i]
                       : share     ? guess.here.relaxing[i - kRelaxes]
                                   : 1;
    open[i] = now > 0 || e.system.right[i] > 0;
  }
  const std::array<double, kUnknowns> by = solved(open);
  // No farther than the equations hold.
  const double most =
      std::max({std::abs(by[kSurface]), std::abs(by[kCosine]), std::abs(by[kSine])});
  const double share = most > kStepMax ? kStepMax / most : 1;
  for (std::size_t j = 0; j < kShapes; ++j) {
    guess.here.shape[j] = std::max(0.0, guess.here.shape[j] + share * by[j]);
  }
  guess.here.surface += share * by[kSurface] * kModelDepthScale;
  for (std::size_t k = 0; k < kTimes; ++k) {
    guess.here.relaxing[k] =
        std::clamp(guess.here.relaxing[k] + share * by[kRelaxes + k], 0.0, 1.0);
  }
  if (!swings) return;
  guess.cosine += share * by[kCosine] * kModelDepthScale;
  guess.sine += share * by[kSine] * kModelDepthScale;
  guess.rate = std::clamp(guess.rate + share * by[kRate],
                          rate_of(static_cast<double>(pace) - 1),
                          rate_of(static_cast<double>(pace)));
  count_from(e.time / e.count, guess);
}

void BreathingEstimator::judge() noexcept {
  const double seen_for = time_ - first_seen_;
  if (seen_for < kStillSeenFor || count_ < kSamplesMin) return;
  // A place that is hardly known ends no belief: with few samples any pace fits any tissue.
  if (believed_ && here_ < kSamplesMin) return;
  best_ = 1;
  for (std::size_t i = 2; i < guesses_.size(); ++i) {
    if (guesses_[i].cost < guesses_[best_].cost) best_ = i;
  }
  const Guess& best = guesses_[best_];
  const double amplitude = std::hypot(best.cosine, best.sine);
  const double explained = guesses_[0].square > 0 ? 1 - best.square / guesses_[0].square : 0;
  const bool early = seen_for < kSeenFor;
  const bool needed = !rests_ && best.square < kClearly * rest_square_;
  believed_ = !early && amplitude > kAmplitudeMin && amplitude < kAmplitudeMax &&
              (believed_ ? explained > kExplainedLeast : explained > kExplainedMin && needed);
  still_ = !believed_ &&
           (still_ || amplitude < (early ? kStillBelowSoon : kStillBelow) || (!early && rests_));
  if (!believed_) return;
  const double angle = best.rate * (time_ - best.origin);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  last_ = {best.cosine * c + best.sine * s, best.sine * c - best.cosine * s, best.rate};
  judged_ = time_;
}

bool BreathingEstimator::settled() const noexcept {
  return still_ || (first_seen_ >= 0 && time_ - first_seen_ >= kSeenFor);
}

double BreathingEstimator::surface() const noexcept { return guesses_[best_].here.surface; }

/// Of a tissue that has let go of nothing yet the force is larger by what relaxes.
std::array<double, BreathingEstimator::kShapes> BreathingEstimator::shapes() const noexcept {
  std::array<double, kShapes> slow = guesses_[best_].here.shape;
  double gain = 1;
  for (const double share : relaxing()) gain += share;
  for (double& shape : slow) shape /= gain;
  return slow;
}

const BreathingEstimator::Shares& BreathingEstimator::relaxing() const noexcept {
  return guesses_[best_].here.relaxing;
}

Swing BreathingEstimator::swing() const noexcept {
  if (presence_ <= 0) return {};
  const double angle = last_.rate * (time_ - judged_);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {presence_ * (last_.now * c + last_.quadrature * s),
          presence_ * (last_.quadrature * c - last_.now * s),
          last_.rate};
}

}  // namespace palp::coupling
