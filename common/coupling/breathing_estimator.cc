#include "common/coupling/breathing_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palp::coupling {
namespace {

using std::numbers::pi;

// Breaths from 6 to 36 a minute.
constexpr double kSlowest = 2 * pi * 0.10;   // [rad/s]
constexpr double kFastest = 2 * pi * 0.60;   // [rad/s]
constexpr double kSeenFor = 2;               // [s], since the first sight, to say anything
constexpr double kSeenForLong = 4;           // [s], to say that it stands still if it might not
constexpr std::size_t kSamplesMin = 30;      // to say anything
constexpr double kAmplitudeMin = 0.2e-3;     // [m]
constexpr double kStillBelow = 0.35e-3;      // [m]
constexpr double kStillBelowSoon = 0.2e-3;   // [m], before it was seen for long
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
constexpr int kSamplesATick = 6;
constexpr int kSamplesATickStill = 2;  // once the surface is known to stand still
constexpr std::uint32_t kRounds = 12;  // through all samples, after the newest of them
constexpr double kKnownAgain = 0.1;    // [-], of what is known: a tissue is not as it was fitted

}  // namespace

double Swing::after(double span) const noexcept {
  return now * std::cos(rate * span) + quadrature * std::sin(rate * span);
}

const BreathPrior* BreathingEstimator::Places::at(const Place& place) const noexcept {
  for (const Known& one : known) {
    if (one.visit > 0 && distance(one.place, place) <= kSamePlace) return &one.found;
  }
  return nullptr;
}

/// In the slot of the same place, else in the oldest.
void BreathingEstimator::Places::remember(const Known& one) noexcept {
  const auto age = [&one](const Known& slot) {
    return slot.visit > 0 && distance(slot.place, one.place) <= kSamePlace ? 0 : slot.visit + 1;
  };
  *std::ranges::min_element(known, {}, age) = one;
}

BreathingEstimator::BreathingEstimator(double period) noexcept : period_{period} {
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    const double pace = (static_cast<double>(i) - 0.5) / static_cast<double>(kPaces);
    const double band = std::pow(kFastest / kSlowest, 0.5 / static_cast<double>(kPaces)) - 1;
    if (i > 0) fits_[i] = BreathFit{kSlowest * std::pow(kFastest / kSlowest, pace), band};
    fits_[i].suppose(here_.expected.tissue);
  }
}

void BreathingEstimator::step() noexcept {
  time_ += period_;
  const double step = period_ / kPresenceTime;
  presence_ = std::clamp(presence_ + (believed_ ? step : -step), 0.0, 1.0);
  fit_some();
}

/// The oldest place of three is forgotten; of the last its tissue is taken as it was found. At a
/// place that is known what was found there is expected, little trusted beside what comes; else a
/// tissue such as the last one.
void BreathingEstimator::new_place(const Place& place) noexcept {
  const BreathPrior found = fits_[best_].found();
  Here there{.place = place, .visit = here_.visit, .expected = here_.expected};
  if (here_.touched) {
    if (here_.samples >= kSamplesMin) {
      BreathPrior again = found;
      for (BreathTissue& row : again.closely) {
        for (double& one : row) one *= kKnownAgain;
      }
      places_.remember({here_.place, here_.visit, again});
    }
    ++there.visit;
    contact_at_ = -1;
    for (BreathFit& fit : fits_) fit.leave();
    there.expected = prior_beside(found, distance(place, here_.place));
  }
  if (const BreathPrior* known = places_.at(place)) {
    there.known = there.told = true;
    there.expected = *known;
    for (BreathFit& fit : fits_) fit.suppose(known->tissue);
    told_.suppose(known->tissue);
  }
  here_ = there;
  turn_.fit = 0;
  turn_.sample = samples_.oldest();
  fits_[0].begin();
}

/// At the first place of all the surface is anywhere.
void BreathingEstimator::touch(double position, double force) noexcept {
  here_.touched = true;
  if (here_.visit > 1) return;
  for (BreathFit& fit : fits_) fit.seek(position, force, 0);
  here_.expected.tissue[kBreathSurface] = fits_[best_].tissue()[kBreathSurface];
}

void BreathingEstimator::see(double position, double force) noexcept {
  for (std::size_t k = 0; k < past_.size(); ++k) {
    past_[k] += period_ / kModelTimes[k] * (force - past_[k]);
  }
  if (force >= kContact) contact_at_ = time_;
  if (contact_at_ < 0 || time_ - contact_at_ > kAfterContact) return;
  if (first_seen_ < 0) first_seen_ = time_;
  if (!here_.touched) {
    touch(position, force);
  } else if (samples_.count > 0) {
    const BreathSample& last = samples_.number(samples_.count - 1).sample;
    const double least =
        std::abs(position - last.position) > kSampleDistance ? kSampleSoonest : kSampleEvery;
    if (time_ - last.at < least) return;
  }
  const BreathSample sample{time_, position, force, past_};
  samples_.add({sample, here_.visit});
  ++here_.samples;
  turn_.rounds = kRounds;
  follow(sample);
}

/// Goes on where it stopped: through all samples with one fit, then with the next.
void BreathingEstimator::fit_some() noexcept {
  if (turn_.rounds == 0) return;
  for (int i = still_ ? kSamplesATickStill : kSamplesATick; i > 0; --i) {
    if (turn_.sample >= samples_.count) {
      fits_[turn_.fit].improve(here_.expected);
      turn_.sample = samples_.oldest();
      turn_.fit = (turn_.fit + 1) % fits_.size();
      fits_[turn_.fit].begin();
      if (turn_.fit > 0) return;
      --turn_.rounds;
      return judge();
    }
    turn_.sample = std::max(turn_.sample, samples_.oldest());
    const Kept& kept = samples_.number(turn_.sample++);
    if (kept.visit + 1 >= here_.visit) {
      fits_[turn_.fit].add(kept.sample, kept.visit == here_.visit);
    }
  }
}

void BreathingEstimator::follow(const BreathSample& sample) noexcept {
  if (believed_ && here_.told) told_.follow(sample);
}

void BreathingEstimator::judge() noexcept {
  const double seen_for = time_ - first_seen_;
  if (seen_for < kSeenFor || samples_.count < kSamplesMin) return;
  // A place that is hardly known ends no belief: with few samples any pace fits any tissue.
  if (believed_ && here_.samples < kSamplesMin) return tell();
  best_ = 1;
  for (std::size_t i = 2; i < fits_.size(); ++i) {
    if (fits_[i].cost() < fits_[best_].cost()) best_ = i;
  }
  const BreathFit& best = fits_[best_];
  const double amplitude = best.amplitude();
  const double explained = fits_[0].square() > 0 ? 1 - best.square() / fits_[0].square() : 0;
  const bool needed = !rests_ && best.square() < kClearly * rest_square_;
  believed_ = amplitude > kAmplitudeMin && amplitude < kAmplitudeMax &&
              (believed_ ? explained > kExplainedLeast : explained > kExplainedMin && needed);
  const bool early = seen_for < kSeenForLong;
  still_ = !believed_ &&
           (still_ || amplitude < (early ? kStillBelowSoon : kStillBelow) || (!early && rests_));
  if (believed_) tell();
}

void BreathingEstimator::tell() noexcept {
  told_ = fits_[best_];
  here_.told = true;
  for (std::uint64_t n = samples_.oldest(); n < samples_.count; ++n) {
    if (samples_.number(n).sample.at > told_.seen_at()) follow(samples_.number(n).sample);
  }
}

bool BreathingEstimator::settled() const noexcept {
  return still_ || (first_seen_ >= 0 && time_ - first_seen_ >= kSeenForLong);
}

/// While the swing fades in, what it lacks is the surface's.
double BreathingEstimator::surface() const noexcept {
  const double lacking = (1 - presence_) * told_.at(time_).displacement();
  return kModelDepthScale * (told_.tissue()[kBreathSurface] + lacking);
}

/// Of a tissue that has let go of nothing yet the force is larger by what relaxes.
std::array<double, kBreathShapes> BreathingEstimator::shapes() const noexcept {
  std::array<double, kBreathShapes> slow{};
  double gain = 1;
  for (const double share : relaxing()) gain += share;
  for (std::size_t j = 0; j < slow.size(); ++j) slow[j] = told_.tissue()[j] / gain;
  return slow;
}

BreathingEstimator::Shares BreathingEstimator::relaxing() const noexcept {
  Shares shares{};
  std::copy_n(told_.tissue().begin() + kBreathRelaxes, shares.size(), shares.begin());
  return shares;
}

Swing BreathingEstimator::swing() const noexcept {
  if (presence_ <= 0) return {};
  const BreathFit::Path now = told_.at(time_);
  const double given = presence_ * kModelDepthScale;
  return {given * now.displacement(), given * now.velocity() / now.rate(), now.rate()};
}

}  // namespace palp::coupling
