#include "patient_site/estimator/paper_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/core/check.h"
#include "patient_site/estimator/cubic_fit.h"
#include "patient_site/estimator/paper_hash.h"
#include "patient_site/estimator/sensor_steps.h"

namespace palp::estimator {
namespace {

constexpr std::size_t kPlacesMax = 32;
constexpr int kStrokesMax = 32;  // of one place; then the older ones are half forgotten
constexpr int kPassesFirst = 4;  // a place's first law corrects itself from nothing
constexpr int kPassesLater = 2;
constexpr double kNoiseFloor = 1e-5;    // [N]
constexpr double kAirOfTouch = 0.6e-3;  // [m]: no model puts the surface farther out
constexpr std::size_t kTouchSamplesMax = 2000;
constexpr double kRateFactorWidth = 0.5;  // [s/m], what may be expected of silicone

/// rms of one sample's noise, from neighbouring samples; steep contact raises it a little.
double neighbour_noise(std::span<const StrokeSample> samples) noexcept {
  double sum = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = samples[i].measured.force - samples[i - 1].measured.force;
    sum += step * step;
  }
  return std::sqrt(sum / (2 * static_cast<double>(samples.size()))) + kNoiseFloor;
}

/// One-dimensional least squares for the rate factor: loading reads high, unloading low.
double fit_rate_factor(std::span<const ContactPoint> points,
                       const ContactLaw& law,
                       double noise,
                       double depth_max) noexcept {
  double information = 1 / (kRateFactorWidth * kRateFactorWidth);
  double sum = 0;
  for (const ContactPoint& point : points) {
    const double depth = point.position - law.surface;
    if (depth > depth_max) continue;
    const double elastic = law.force(depth);
    const double regressor = elastic * point.rate;
    const double weight = 1 / (noise * noise / point.count + 1e-8 + 1e-6 * elastic * elastic);
    sum += weight * regressor * (point.force - elastic);
    information += weight * regressor * regressor;
  }
  return sum / information;
}

struct Misfit {
  double mean{};  ///< [N], measured minus law, in contact
  double rms{};   ///< [N]
};

Misfit compare(std::span<const ContactPoint> points, const ContactLaw& law) noexcept {
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (const ContactPoint& point : points) {
    if (point.position < law.surface) continue;
    const double elastic = law.force(point.position - law.surface);
    const double rest = point.force - elastic * (1 + law.rate_factor * point.rate);
    sum += point.count * rest;
    squares += point.count * rest * rest;
    count += point.count;
  }
  if (!(count > 0)) return {};
  return {sum / count, std::sqrt(squares / count)};
}

}  // namespace

PaperEstimator::PaperEstimator(const PaperEstimatorConfig& config)
    : config_{config},
      cutter_{config.cutter},
      co_filter_{config.sensor.pole, config.period},
      position_filter_{config.filter_cut_off, config.period},
      force_filter_{config.filter_cut_off, config.period},
      filter_gain_{position_filter_.gain()} {
  PALP_CHECK(config.fit_range > 0 && config.indentation_min > 0, "a stroke has a length");
  places_.reserve(kPlacesMax);
}

std::optional<DepthEstimate> PaperEstimator::add(const ContactSample& sample) {
  if (!std::isfinite(sample.position) || !std::isfinite(sample.force) ||
      !std::isfinite(sample.lateral)) {
    return std::nullopt;
  }
  const bool follows = previous_ && sample.at > previous_->at &&
                       sample.at - previous_->at <= config_.gap_max &&
                       std::abs(sample.lateral - previous_->lateral) <= config_.place_size;
  if (!follows) {
    cutter_.reset();
    learning_.reset();
    previous_.reset();
  }
  const StrokeCutter::Event event = cutter_.add(filter(sample));
  previous_ = sample;
  if (event == StrokeCutter::Event::Released) learn_unloading();
  if (event != StrokeCutter::Event::Reversed) return std::nullopt;
  return estimate_stroke();
}

std::optional<PaperEstimator::PlaceData> PaperEstimator::place() const {
  if (!learning_ || !places_[*learning_].law) return std::nullopt;
  const Place& place = places_[*learning_];
  return PlaceData{
      .lateral = place.lateral,
      .surface = place.law->surface,
      .rate_factor = place.law->rate_factor,
      .noise = place.contact_count > 0
                   ? std::max(kNoiseFloor, std::sqrt(place.contact_squares / place.contact_count))
                   : noise_,
      .touches = place.touches,
      .touched = place.touched,
      .generation = place.generation};
}

StrokeSample PaperEstimator::filter(const ContactSample& sample) noexcept {
  StrokeSample out{.measured = sample, .tip = sample.position};
  if (previous_) {
    out.position = position_filter_.step(co_filter_.step(sample.position));
    out.force = force_filter_.step(sample.force);
  } else {
    co_filter_.reset(sample.position);
    position_filter_.reset(sample.position);
    force_filter_.reset(sample.force);
    out.position = sample.position;
    out.force = sample.force;
  }
  return out;
}

PaperEstimator::Measured PaperEstimator::measure() const noexcept {
  Measured measured;
  const std::span<const StrokeSample> loading = cutter_.loading();
  measured.position_max = loading.back().position;
  for (const StrokeSample& sample : loading) {
    measured.force_max = std::max(measured.force_max, sample.force);
    measured.saturated |= std::abs(sample.measured.force) >= config_.sensor.range;
    if (sample.force < config_.cutter.contact_force) continue;
    if (measured.in_contact++ == 0) measured.first_contact = sample.position;
  }
  measured.noise = neighbour_noise(loading);
  return measured;
}

std::size_t PaperEstimator::find_place(double lateral, double first_contact) {
  ++uses_;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (std::abs(places_[i].lateral - lateral) <= config_.place_size) {
      places_[i].used = uses_;
      return i;
    }
  }
  Place fresh{.lateral = lateral,
              .first_contact = first_contact,
              .curve = ContactCurve{first_contact},
              .law = std::nullopt,
              .strokes = 0,
              .touches = {},
              .touched = 0,
              .generation = ++generations_,
              .contact_squares = 0,
              .contact_count = 0,
              .used = uses_};
  if (places_.size() < kPlacesMax) {
    places_.push_back(fresh);
    return places_.size() - 1;
  }
  const auto oldest =
      std::min_element(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
        return a.used < b.used;
      });
  *oldest = fresh;
  return static_cast<std::size_t>(oldest - places_.begin());
}

DepthEstimate PaperEstimator::estimate_stroke() {
  const Measured measured = measure();
  DepthEstimate estimate;
  estimate.number = ++number_;
  estimate.stroke_ended_at = cutter_.loading().back().measured.at;
  estimate.stroke_began_at = cutter_.loading().front().measured.at;
  estimate.lateral = previous_->lateral;
  estimate.force_max = measured.force_max;
  estimate.verdict = DepthVerdict::Invalid;
  const auto invalid = [&](DepthReason reason) {
    estimate.reason = reason;
    return estimate;
  };
  if (cutter_.pressed_again()) {
    if (learning_) keep_touch(places_[*learning_]);
    return invalid(DepthReason::StrokeNotMonotone);
  }
  if (measured.saturated) return invalid(DepthReason::ForceSaturated);
  if (measured.noise > config_.noise_max) return invalid(DepthReason::TooNoisy);
  if (measured.in_contact < config_.samples_min) return invalid(DepthReason::StrokeTooFewSamples);
  const std::size_t index = find_place(previous_->lateral, measured.first_contact);
  if (!learn_loading(places_[index], measured, estimate)) return invalid(DepthReason::NoContact);
  learning_ = index;
  if (estimate.indentation_max < config_.indentation_min) {
    return invalid(DepthReason::StrokeTooShort);
  }
  const HashVerdict verdict = judge_hash(estimate.hash);
  estimate.verdict = verdict.verdict;
  estimate.reason = verdict.reason;
  estimate.depth = verdict.depth;
  estimate.depth_low = verdict.depth;
  estimate.depth_high = verdict.depth;
  return estimate;
}

/// Fits surface and law to this stroke and those before it, pass by pass: what the filters did to
/// the force is computed with the law of the pass before.
bool PaperEstimator::learn_loading(Place& place,
                                   const Measured& measured,
                                   DepthEstimate& estimate) {
  noise_ = measured.noise;
  std::optional<ContactLaw> law = place.law;
  Branch own = branch_curve(place, ContactCurve::Branch::Loading, law, noise_);
  if (law && std::abs(compare(own.curve.points(), *law).mean) > config_.change_force) {
    place.curve = ContactCurve{measured.first_contact};
    place.first_contact = measured.first_contact;
    place.law.reset();
    place.strokes = 0;
    place.touches.clear();
    place.touched = 0;
    place.generation = ++generations_;
    place.contact_squares = place.contact_count = 0;
    law.reset();
    own = branch_curve(place, ContactCurve::Branch::Loading, law, noise_);
  }
  const int passes = law ? kPassesLater : kPassesFirst;
  for (int pass = 0; pass < passes; ++pass) {
    if (pass > 0) own = branch_curve(place, ContactCurve::Branch::Loading, law, noise_);
    if (law) noise_ = std::max(kNoiseFloor, own.noise);
    ContactCurve all = own.curve;
    all.add(place.curve);
    const std::vector<ContactPoint> points = all.points();
    law = find_surface({.points = points,
                        .first_contact = place.first_contact,
                        .noise = noise_,
                        .rate_factor = law ? law->rate_factor : 0,
                        .surface = law ? std::optional{law->surface} : std::nullopt},
                       config_.surface);
    if (!law) return false;
  }
  place.law = law;
  place.curve.add(own.curve);
  if (place.touches.size() == kTouchesKept) place.touches.erase(place.touches.begin());
  place.touches.push_back(touch_of(place));
  ++place.touched;
  place.contact_squares += own.contact_squares;
  place.contact_count += own.contact_count;
  if (++place.strokes == kStrokesMax) {
    place.curve.scale(0.5);
    place.strokes /= 2;
  }
  describe(estimate, *law, own.curve, measured.position_max);
  return true;
}

void PaperEstimator::describe(DepthEstimate& estimate,
                              const ContactLaw& law,
                              const ContactCurve& own,
                              double position_max) const {
  estimate.surface = law.surface;
  estimate.indentation_max = position_max - law.surface;
  std::array<CurvePoint, 81> curve{};  // every 0.05 mm; 0.25 mm gives the same h within 0.05 %
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double depth = config_.fit_range * static_cast<double>(i) / (curve.size() - 1);
    curve[i] = {depth, law.force(depth)};
  }
  if (const std::optional<Cubic> cubic = fit_cubic(curve)) estimate.hash = hash(*cubic);
  estimate.fit_rms = compare(own.points(), law).rms;
}

/// The branch after the reversal is no measurement of h, but it shows the surface once more and how
/// much the rate of indentation adds to the force.
void PaperEstimator::learn_unloading() {
  if (!learning_) return;
  Place& place = places_[*learning_];
  learning_.reset();
  keep_touch(place);
  if (!place.law || cutter_.pressed_again()) return;
  place.curve.add(branch_curve(place, ContactCurve::Branch::Unloading, place.law, noise_).curve);
  const std::vector<ContactPoint> points = place.curve.points();
  for (int pass = 0; pass < kPassesLater; ++pass) {
    const double rate_factor =
        fit_rate_factor(points, *place.law, noise_, config_.surface.indentation_max);
    const std::optional<ContactLaw> law = find_surface({.points = points,
                                                        .first_contact = place.first_contact,
                                                        .noise = noise_,
                                                        .rate_factor = rate_factor,
                                                        .surface = place.law->surface},
                                                       config_.surface);
    if (!law) return;
    place.law = law;
  }
}

/// The present stroke as far as it has come. One that is not monotone says nothing of h, but its
/// samples say as much of the tissue as any.
void PaperEstimator::keep_touch(Place& place) const {
  if (place.law && !place.touches.empty()) place.touches.back() = touch_of(place);
}

/// From a little above the surface to where the force saturates, if it does; thinned if it is a
/// long one.
Touch PaperEstimator::touch_of(const Place& place) const {
  const std::span<const StrokeSample> samples = cutter_.samples();
  const double begin = place.law->surface - kAirOfTouch;
  std::size_t first = 1;
  while (first < samples.size() && samples[first].tip < begin) ++first;
  const std::size_t stride = 1 + (samples.size() - first) / kTouchSamplesMax;
  Touch out;
  out.reserve((samples.size() - first) / stride + 1);
  for (std::size_t i = first; i < samples.size(); i += stride) {
    if (std::abs(samples[i].measured.force) >= config_.sensor.range) break;
    const std::size_t before = i < first + stride ? i - 1 : i - stride;
    out.push_back({.tip = samples[i].tip,
                   .force = samples[i].measured.force,
                   .span = seconds(samples[i].measured.at - samples[before].measured.at)});
  }
  return out;
}

PaperEstimator::Branch PaperEstimator::branch_curve(const Place& place,
                                                    ContactCurve::Branch branch,
                                                    const std::optional<ContactLaw>& law,
                                                    double noise) const {
  Branch out{.curve = ContactCurve{place.first_contact},
             .noise = 0,
             .contact_squares = 0,
             .contact_count = 0};
  const std::span<const StrokeSample> samples = cutter_.samples();
  const SensorSteps steps{noise, config_.sensor.step};
  double sensed = 0;    // [N], the law behind the transducer's pole
  double filtered = 0;  // [N], and behind the low pass
  double bias = 0;      // [N], of the steps, behind the low pass
  double modelled_before = 0;
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const StrokeSample& sample = samples[i];
    const double dt = seconds(sample.measured.at - samples[i - 1].measured.at);
    const double rate = (sample.position - samples[i - 1].position) / dt;
    const bool loading = i < cutter_.loading_count();
    double correction = 0;
    if (law) {
      const double tip_rate = (sample.tip - samples[i - 1].tip) / dt;
      const double modelled =
          law->force(sample.tip - law->surface) * (1 + law->rate_factor * tip_rate);
      // The transducer's pole is continuous: between two samples it sees the mean of both.
      sensed += co_filter_.gain() * ((modelled + modelled_before) / 2 - sensed);
      modelled_before = modelled;
      filtered += filter_gain_ * (sensed - filtered);
      const double offset = steps.at(sensed).offset;
      bias += filter_gain_ * (offset - bias);
      correction = filtered -
                   law->force(sample.position - law->surface) * (1 + law->rate_factor * rate) +
                   bias;
      const double rest = sample.measured.force - sensed - offset;
      if (loading) squares += rest * rest;
      // In the air the steps hide most of the noise.
      if (loading && sensed > config_.sensor.step) {
        out.contact_squares += rest * rest;
        out.contact_count += 1;
      }
    }
    count += loading ? 1 : 0;
    if (loading == (branch == ContactCurve::Branch::Loading)) {
      out.curve.add(branch, sample.position, sample.force - correction, rate);
    }
  }
  out.noise = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  return out;
}

}  // namespace palp::estimator
