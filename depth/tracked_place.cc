#include "depth/tracked_place.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace palp::depth {
namespace {

constexpr int kStrokesMax = 32;  // of one place; then the older ones are half forgotten
constexpr int kPassesFirst = 4;  // a place's first law corrects itself from nothing
constexpr int kPassesLater = 2;
constexpr double kAirOfTouch = 0.6e-3;  // [m]: no model puts the surface farther out
constexpr std::size_t kTouchSamplesMax = 2000;
constexpr double kRateFactorWidth = 0.5;  // [s/m], what may be expected of silicone

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

TrackedPlace::TrackedPlace(const Place& place, double first_contact, std::uint64_t generation)
    : place_{place},
      first_contact_{first_contact},
      curve_{first_contact},
      generation_{generation} {}

TouchedPlace TrackedPlace::seen(std::size_t index, const PlaceReading& reading) const {
  return {.index = index,
          .place = place_,
          .surface = law_->surface,
          .rate_factor = law_->rate_factor,
          .noise = contact_.empty() ? noise_
                                    : std::max(kNoiseFloor, contact_.rms(reading.force_quantum)),
          .touches = touches_,
          .touched = touched_,
          .generation = generation_};
}

void TrackedPlace::start_afresh(double first_contact, std::uint64_t generation) {
  *this = TrackedPlace{place_, first_contact, generation};
}

/// Pass by pass: what the filters did to the force is computed with the law of the pass before.
std::optional<double> TrackedPlace::learn_loading(const StrokeCutter& stroke,
                                                  const PlaceReading& reading,
                                                  double first_contact,
                                                  double noise,
                                                  std::uint64_t& generations) {
  const auto loading = [&](const std::optional<ContactLaw>& law) {
    return branch_curve(stroke, reading, ContactCurve::Branch::Loading, law);
  };
  noise_ = noise;
  std::optional<ContactLaw> law = law_;
  Branch own = loading(law);
  if (law && std::abs(compare(own.curve.points(), *law).mean) > reading.change_force) {
    start_afresh(first_contact, ++generations);
    noise_ = noise;
    law.reset();
    own = loading(law);
  }
  const int passes = law ? kPassesLater : kPassesFirst;
  for (int pass = 0; pass < passes; ++pass) {
    if (pass > 0) own = loading(law);
    if (law) noise_ = std::max(kNoiseFloor, own.noise);
    ContactCurve all = own.curve;
    all.add(curve_);
    const std::vector<ContactPoint> points = all.points();
    law = find_surface({.points = points,
                        .first_contact = first_contact_,
                        .noise = noise_,
                        .rate_factor = law ? law->rate_factor : 0,
                        .surface = law ? std::optional{law->surface} : std::nullopt},
                       reading.surface);
    if (!law) return std::nullopt;
  }
  law_ = law;
  curve_.add(own.curve);
  if (touches_.size() == kTouchesKept) touches_.erase(touches_.begin());
  touches_.push_back(touch_of(stroke, reading.force_range));
  ++touched_;
  contact_.add(own.contact);
  if (++strokes_ == kStrokesMax) {
    curve_.scale(0.5);
    strokes_ /= 2;
  }
  return compare(own.curve.points(), *law).rms;
}

void TrackedPlace::learn_unloading(const StrokeCutter& stroke, const PlaceReading& reading) {
  keep_touch(stroke, reading);
  if (!law_ || stroke.pressed_again()) return;
  curve_.add(branch_curve(stroke, reading, ContactCurve::Branch::Unloading, law_).curve);
  const std::vector<ContactPoint> points = curve_.points();
  for (int pass = 0; pass < kPassesLater; ++pass) {
    const double rate_factor =
        fit_rate_factor(points, *law_, noise_, reading.surface.indentation_max);
    const std::optional<ContactLaw> law = find_surface({.points = points,
                                                        .first_contact = first_contact_,
                                                        .noise = noise_,
                                                        .rate_factor = rate_factor,
                                                        .surface = law_->surface},
                                                       reading.surface);
    if (!law) return;
    law_ = law;
  }
}

void TrackedPlace::keep_touch(const StrokeCutter& stroke, const PlaceReading& reading) {
  if (law_ && !touches_.empty()) touches_.back() = touch_of(stroke, reading.force_range);
}

/// From a little above the surface to where the force saturates, if it does; thinned if it is a
/// long one.
Touch TrackedPlace::touch_of(const StrokeCutter& stroke, double force_range) const {
  const std::span<const StrokeSample> samples = stroke.samples();
  const double begin = law_->surface - kAirOfTouch;
  std::size_t first = 1;
  while (first < samples.size() && samples[first].tip < begin) ++first;
  const std::size_t stride = 1 + (samples.size() - first) / kTouchSamplesMax;
  Touch out;
  out.reserve((samples.size() - first) / stride + 1);
  std::size_t before = first - 1;
  for (std::size_t i = first; i < samples.size(); ++i) {
    // A reading among samples that are none is not thinned.
    const bool alone = samples[i].read && !samples[i - 1].read;
    if ((i - first) % stride != 0 && !alone) continue;
    if (std::abs(samples[i].measured.force) >= force_range) break;
    out.push_back({.tip = samples[i].tip,
                   .force = samples[i].measured.force,
                   .span = seconds(samples[i].measured.at - samples[before].measured.at),
                   .read = samples[i].read});
    before = i;
  }
  return out;
}

TrackedPlace::Branch TrackedPlace::branch_curve(const StrokeCutter& stroke,
                                                const PlaceReading& reading,
                                                ContactCurve::Branch branch,
                                                const std::optional<ContactLaw>& law) const {
  Branch out{.curve = ContactCurve{first_contact_}, .noise = 0, .contact = {}};
  const std::span<const StrokeSample> samples = stroke.samples();
  const SensorSteps steps{noise_, reading.force_quantum};
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
    const bool loading = i < stroke.loading_count();
    double correction = 0;
    if (law) {
      const double tip_rate = (sample.tip - samples[i - 1].tip) / dt;
      const double modelled =
          law->force(sample.tip - law->surface) * (1 + law->rate_factor * tip_rate);
      // The transducer's pole is continuous: between two samples it sees the mean of both.
      sensed += reading.pole_gain * ((modelled + modelled_before) / 2 - sensed);
      modelled_before = modelled;
      filtered += reading.filter_gain * (sensed - filtered);
      const double offset = steps.at(sensed).offset;
      bias += reading.filter_gain * (offset - bias);
      correction = filtered -
                   law->force(sample.position - law->surface) * (1 + law->rate_factor * rate) +
                   bias;
      const double rest = sample.measured.force - sensed - offset;
      if (loading && sample.read) squares += rest * rest;
      if (loading && sample.read && sensed > 0) {
        out.contact.add(sensed, sample.measured.force - sensed, reading.force_quantum);
      }
    }
    if (!sample.read) continue;
    count += loading ? 1 : 0;
    if (loading == (branch == ContactCurve::Branch::Loading)) {
      out.curve.add(branch, sample.position, sample.force - correction, rate);
    }
  }
  out.noise = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  return out;
}

}  // namespace palp::depth
