#include "common/coupling/surface_swing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palp::coupling {
namespace {

using std::numbers::pi;

// Breaths from 6 to 36 a minute.
constexpr double kSlowest = 2 * pi * 0.10;  // [rad/s]
constexpr double kFastest = 2 * pi * 0.60;  // [rad/s]
// A short arc fits many paces: an adult at rest breathes 12 to 20 times a minute.
constexpr double kUsual = 2 * pi * 0.26;  // [rad/s]
constexpr double kUnusual = 0.15;         // [-], of what it explains, an octave away
constexpr double kMemory = 8;             // [s] of contact
constexpr double kJudgeEvery = 0.05;      // [s]
constexpr double kSeenFor = 2.5;          // [s], since the first sight
constexpr double kAmplitudeMin = 0.2e-3;  // [m]
constexpr double kStillBelow = 0.35e-3;   // [m]
constexpr double kAmplitudeMax = 4e-3;    // [m]
constexpr double kExplainedMin = 0.6;     // [-], to begin believing
constexpr double kExplainedLeast = 0.3;   // [-], to go on
constexpr double kPresenceTime = 0.3;     // [s]
constexpr double kRidge = 0.02;           // [-]
constexpr double kSightPeriod = 5e-3;     // [s], of see()

}  // namespace

double Swing::after(double span) const noexcept {
  return now * std::cos(rate * span) + quadrature * std::sin(rate * span);
}

SurfaceSwing::SurfaceSwing(double period) noexcept : period_{period} {
  for (std::size_t i = 0; i < kFrequencies; ++i) rates_[i] = rate_of(static_cast<double>(i));
}

double SurfaceSwing::rate_of(double index) const noexcept {
  const double share = index / (kFrequencies - 1);
  return kSlowest * std::pow(kFastest / kSlowest, share);
}

void SurfaceSwing::step() noexcept {
  time_ += period_;
  const double step = period_ / kPresenceTime;
  presence_ = std::clamp(presence_ + (believed_ ? step : -step), 0.0, 1.0);
}

double SurfaceSwing::centred_square() const noexcept {
  return past_square_ + (weight_ > 0 ? seen_square_ - seen_ * seen_ / weight_ : 0);
}

SurfaceSwing::Past SurfaceSwing::centred(std::size_t index) const noexcept {
  Past all = past_[index];
  if (!(weight_ > 0)) return all;
  const Sums& sums = sums_[index];
  all.cos_cos += sums.cos_cos - sums.cosine * sums.cosine / weight_;
  all.cos_sin += sums.cos_sin - sums.cosine * sums.sine / weight_;
  all.sin_sin += sums.sin_sin - sums.sine * sums.sine / weight_;
  all.seen_cos += sums.seen_cos - seen_ * sums.cosine / weight_;
  all.seen_sin += sums.seen_sin - seen_ * sums.sine / weight_;
  return all;
}

void SurfaceSwing::new_mean() noexcept {
  for (std::size_t i = 0; i < kFrequencies; ++i) past_[i] = centred(i);
  past_square_ = centred_square();
  past_weight_ += weight_;
  sums_ = {};
  weight_ = seen_ = seen_square_ = 0;
}

void SurfaceSwing::see(double position, double weight) noexcept {
  if (first_seen_ < 0) first_seen_ = time_;
  const double keep = 1 - weight * kSightPeriod / kMemory;
  past_weight_ *= keep;
  past_square_ *= keep;
  weight_ = keep * weight_ + weight;
  seen_ = keep * seen_ + weight * position;
  seen_square_ = keep * seen_square_ + weight * position * position;
  for (std::size_t i = 0; i < kFrequencies; ++i) {
    const double angle = rates_[i] * time_;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    Past& past = past_[i];
    past.cos_cos *= keep;
    past.cos_sin *= keep;
    past.sin_sin *= keep;
    past.seen_cos *= keep;
    past.seen_sin *= keep;
    Sums& sums = sums_[i];
    sums.cosine = keep * sums.cosine + weight * c;
    sums.sine = keep * sums.sine + weight * s;
    sums.cos_cos = keep * sums.cos_cos + weight * c * c;
    sums.cos_sin = keep * sums.cos_sin + weight * c * s;
    sums.sin_sin = keep * sums.sin_sin + weight * s * s;
    sums.seen_cos = keep * sums.seen_cos + weight * position * c;
    sums.seen_sin = keep * sums.seen_sin + weight * position * s;
  }
  if (time_ - judged_ < kJudgeEvery) return;
  judged_ = time_;
  judge();
}

/// Least squares about the weighted means; a little ridge keeps a short arc from becoming a huge
/// swing.
SurfaceSwing::Wave SurfaceSwing::solve(std::size_t index) const noexcept {
  const Past all = centred(index);
  const double ridge = kRidge * (weight_ + past_weight_);
  const double cc = all.cos_cos + ridge;
  const double ss = all.sin_sin + ridge;
  const double cs = all.cos_sin;
  const double yc = all.seen_cos;
  const double ys = all.seen_sin;
  const double determinant = cc * ss - cs * cs;
  if (!(determinant > 0)) return {};
  Wave wave;
  wave.cosine = (ss * yc - cs * ys) / determinant;
  wave.sine = (cc * ys - cs * yc) / determinant;
  wave.explained = wave.cosine * yc + wave.sine * ys;
  return wave;
}

void SurfaceSwing::judge() noexcept {
  const double spread = centred_square();
  if (time_ - first_seen_ < kSeenFor || !(spread > 0)) return;
  std::array<Wave, kFrequencies> waves;
  std::size_t at = 0;
  double most = 0;
  for (std::size_t i = 0; i < kFrequencies; ++i) {
    waves[i] = solve(i);
    const double octaves = std::log2(rates_[i] / kUsual);
    const double plausible = waves[i].explained * (1 - kUnusual * octaves * octaves);
    if (plausible <= most) continue;
    most = plausible;
    at = i;
  }
  const Wave& best = waves[at];
  const double amplitude = std::hypot(best.cosine, best.sine);
  const double explained = best.explained / spread;
  believed_ = amplitude > kAmplitudeMin && amplitude < kAmplitudeMax &&
              explained > (believed_ ? kExplainedLeast : kExplainedMin);
  still_ = !believed_ && (still_ || amplitude < kStillBelow);
  if (!believed_) return;
  // Between the frequencies tried: the top of the parabola through the best and its neighbours.
  double between = 0;
  if (at > 0 && at + 1 < kFrequencies) {
    const double left = waves[at - 1].explained;
    const double right = waves[at + 1].explained;
    const double bend = left - 2 * best.explained + right;
    if (bend < 0) between = std::clamp(0.5 * (left - right) / bend, -0.5, 0.5);
  }
  const double angle = rates_[at] * time_;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  last_.now = best.cosine * c + best.sine * s;
  last_.quadrature = best.sine * c - best.cosine * s;
  last_.rate = rate_of(static_cast<double>(at) + between);
}

Swing SurfaceSwing::swing() const noexcept {
  if (presence_ <= 0) return {};
  const double angle = last_.rate * (time_ - judged_);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {presence_ * (last_.now * c + last_.quadrature * s),
          presence_ * (last_.quadrature * c - last_.now * s),
          last_.rate};
}

}  // namespace palp::coupling
