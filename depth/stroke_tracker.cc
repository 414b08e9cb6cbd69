#include "depth/stroke_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/core/check.h"
#include "depth/cubic_fit.h"
#include "depth/paper_hash.h"

namespace palp::depth {
namespace {

/// rms of one sample's noise, from neighbouring samples; steep contact raises it a little.
double neighbour_noise(std::span<const StrokeSample> samples) noexcept {
  double sum = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = samples[i].measured.force - samples[i - 1].measured.force;
    sum += step * step;
  }
  return std::sqrt(sum / (2 * static_cast<double>(samples.size()))) + kNoiseFloor;
}

}  // namespace

bool StrokeTrackerConfig::same_place(const Place& one, const Place& other) const noexcept {
  return distance(one, other) <= place_size;
}

StrokeTracker::StrokeTracker(const StrokeTrackerConfig& config)
    : config_{config},
      reading_{.pole_gain = LowPass{config.sensor.pole, config.period}.gain(),
               .filter_gain = LowPass{config.filter_cut_off, config.period}.gain(),
               .force_quantum = config.sensor.step,
               .force_range = config.sensor.range,
               .change_force = config.change_force,
               .surface = config.surface},
      aligner_{{.period = config.period,
                .stage_rate = config.stage_rate,
                .sensor_rate = config.sensor.rate}},
      cutter_{config.cutter},
      co_filter_{config.sensor.pole, config.period},
      position_filter_{config.filter_cut_off, config.period},
      force_filter_{config.filter_cut_off, config.period} {
  PALP_CHECK(config.fit_range > 0, "a law is read over a length");
  places_.reserve(kPlacesMax);
  used_.reserve(kPlacesMax);
}

std::optional<Stroke> StrokeTracker::take(const ContactSample& sample) {
  if (!std::isfinite(sample.position) || !std::isfinite(sample.force) || !is_finite(sample.place)) {
    return std::nullopt;
  }
  aligner_.add(sample);
  std::optional<Stroke> stroke;
  while (const auto aligned = aligner_.take()) {
    if (auto seen = follow(*aligned)) stroke = std::move(seen);
  }
  return stroke;
}

std::optional<Stroke> StrokeTracker::follow(const AlignedSample& aligned) {
  const ContactSample& sample = aligned.sample;
  const bool follows = previous_ && sample.at > previous_->at &&
                       sample.at - previous_->at <= config_.gap_max &&
                       config_.same_place(sample.place, began_);
  if (!follows) {
    cutter_.reset();
    learning_.reset();
    previous_.reset();
    began_ = sample.place;
  }
  const StrokeCutter::Event event = cutter_.add(filter(aligned));
  previous_ = sample;
  if (event == StrokeCutter::Event::Released && learning_) {
    places_[*learning_].learn_unloading(cutter_, reading_);
    learning_.reset();
  }
  if (event != StrokeCutter::Event::Reversed) return std::nullopt;
  return describe_stroke();
}

void StrokeTracker::forget() {
  aligner_.reset();
  cutter_.reset();
  previous_.reset();
  places_.clear();
  used_.clear();
  learning_.reset();
}

StrokeSample StrokeTracker::filter(const AlignedSample& aligned) noexcept {
  const ContactSample& sample = aligned.sample;
  StrokeSample out{.measured = sample, .tip = sample.position, .read = aligned.read};
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

StrokeTracker::Measured StrokeTracker::measure() const noexcept {
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

std::size_t StrokeTracker::find_place(const Place& place, double first_contact) {
  ++uses_;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (config_.same_place(places_[i].place(), place)) {
      used_[i] = uses_;
      return i;
    }
  }
  const TrackedPlace fresh{place, first_contact, ++generations_};
  if (places_.size() < kPlacesMax) {
    places_.push_back(fresh);
    used_.push_back(uses_);
    return places_.size() - 1;
  }
  const auto oldest = std::min_element(used_.begin(), used_.end());
  *oldest = uses_;
  const auto index = static_cast<std::size_t>(oldest - used_.begin());
  places_[index] = fresh;
  return index;
}

DepthReason StrokeTracker::validity(const Measured& measured) const noexcept {
  if (cutter_.pressed_again()) return DepthReason::StrokeNotMonotone;
  if (measured.saturated) return DepthReason::ForceSaturated;
  if (measured.noise > config_.noise_max) return DepthReason::TooNoisy;
  if (measured.in_contact < config_.samples_min) return DepthReason::StrokeTooFewSamples;
  return DepthReason::Ok;
}

Stroke StrokeTracker::describe_stroke() {
  const Measured measured = measure();
  Stroke stroke;
  stroke.number = ++number_;
  stroke.began_at = cutter_.loading().front().measured.at;
  stroke.ended_at = cutter_.loading().back().measured.at;
  stroke.place = previous_->place;
  stroke.force_max = measured.force_max;
  stroke.reason = validity(measured);
  if (stroke.reason == DepthReason::StrokeNotMonotone && learning_) {
    places_[*learning_].keep_touch(cutter_, reading_);
  }
  if (stroke.reason != DepthReason::Ok) return stroke;
  const std::size_t index = find_place(stroke.place, measured.first_contact);
  TrackedPlace& place = places_[index];
  const std::optional<double> rms =
      place.learn_loading(cutter_, reading_, measured.first_contact, measured.noise, generations_);
  if (!rms) {
    stroke.reason = DepthReason::NoContact;
    return stroke;
  }
  learning_ = index;
  stroke.indentation_max = measured.position_max - place.law()->surface;
  stroke.hash = hash_of(*place.law());
  stroke.fit_rms = *rms;
  stroke.known = place.seen(index, reading_);
  return stroke;
}

double StrokeTracker::hash_of(const ContactLaw& law) const noexcept {
  std::array<CurvePoint, 81> curve{};  // every 0.05 mm; 0.25 mm gives the same h within 0.05 %
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double depth = config_.fit_range * static_cast<double>(i) / (curve.size() - 1);
    curve[i] = {depth, law.force(depth)};
  }
  const std::optional<Cubic> cubic = fit_cubic(curve);
  return cubic ? hash(*cubic) : 0;
}

}  // namespace palp::depth
