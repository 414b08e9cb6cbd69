#include "depth/reading_aligner.h"

#include <algorithm>
#include <cmath>

namespace palp::depth {
namespace {

/// Through the values at the four times, with the slope at the inner two that their neighbours
/// give.
/// @returns the value `at` between the inner two.
double between(const std::array<double, 4>& times, const std::array<double, 4>& values, double at) {
  const auto slope = [&](std::size_t i) {
    const double before = times[i] - times[i - 1];
    const double after = times[i + 1] - times[i];
    const double steep_before = (values[i] - values[i - 1]) / before;
    const double steep_after = (values[i + 1] - values[i]) / after;
    return (after * steep_before + before * steep_after) / (before + after);
  };
  const double span = times[2] - times[1];
  const double u = (at - times[1]) / span;
  const double rest = 1 - u;
  return rest * rest * (1 + 2 * u) * values[1] + u * u * (3 - 2 * u) * values[2] +
         span * u * rest * (rest * slope(1) - u * slope(2));
}

}  // namespace

double ReadingAligner::gap_of(double rate) const noexcept {
  return std::max(config_.gap_max, config_.readings_missing / rate);
}

void ReadingAligner::add(const ContactSample& sample) {
  const TimePoint tip_at = sample.at - sample.position_age;
  const TimePoint force_at = sample.at - sample.force_age;
  if (tips_.empty() || tip_at > tips_.back().at) {
    tips_.push_back({tip_at, sample.position, sample.place});
  }
  if (forces_.empty() || force_at > forces_.back().at) {
    forces_.push_back({force_at, sample.force, sample.place});
  }
}

/// Nothing until the readings around it are known, or where there are none around it.
std::optional<double> ReadingAligner::tip_at(TimePoint at) {
  broken_ = tips_.front().at > at;
  while (tips_.size() > 2 && tips_[2].at <= at) tips_.pop_front();
  const auto after = std::ranges::find_if(tips_, [&](const Reading& one) { return one.at >= at; });
  if (after == tips_.end()) return std::nullopt;
  if (after->at == at) return after->value;
  if (broken_) return std::nullopt;
  const auto index = static_cast<std::size_t>(after - tips_.begin());
  if (seconds(tips_[index].at - tips_[index - 1].at) > gap_of(config_.stage_rate)) {
    broken_ = true;
    return std::nullopt;
  }
  if (index + 1 == tips_.size()) return std::nullopt;
  std::array<double, 4> times{};
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Reading& one = tips_[index + i > 2 ? index + i - 2 : 0];
    times[i] = seconds(one.at - at);
    values[i] = one.value;
  }
  if (index == 1) {  // nothing before: as straight as behind
    times[0] = times[1] - 1;
    values[0] = values[1] - (values[2] - values[1]) / (times[2] - times[1]);
  }
  return between(times, values, 0);
}

std::optional<AlignedSample> ReadingAligner::take() {
  while (!forces_.empty()) {
    if (steps_ == 0) {  // the first of all, or behind a gap
      const Reading& first = forces_.front();
      const std::optional<double> tip = tip_at(first.at);
      if (!tip && !broken_) return std::nullopt;
      if (!tip) {
        forces_.pop_front();
        continue;
      }
      steps_ = 1;
      step_ = 0;
      return AlignedSample{
          {.at = first.at, .position = *tip, .force = first.value, .place = first.place}, true};
    }
    if (forces_.size() < 2) return std::nullopt;
    const Reading& from = forces_[0];
    const Reading& to = forces_[1];
    const double span = seconds(to.at - from.at);
    if (span > gap_of(config_.sensor_rate)) {
      steps_ = 0;
      forces_.pop_front();
      continue;
    }
    steps_ =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(span / config_.period)));
    const bool last = step_ + 1 == steps_;
    const double share = static_cast<double>(step_ + 1) / static_cast<double>(steps_);
    const TimePoint at = last ? to.at : from.at + from_seconds(share * span);
    const std::optional<double> tip = tip_at(at);
    if (!tip && !broken_) return std::nullopt;
    if (!tip) {
      steps_ = 0;
      forces_.pop_front();
      continue;
    }
    const double force = last ? to.value : from.value + share * (to.value - from.value);
    step_ = last ? 0 : step_ + 1;
    const Place place = to.place;
    if (last) forces_.pop_front();
    return AlignedSample{{.at = at, .position = *tip, .force = force, .place = place}, last};
  }
  return std::nullopt;
}

}  // namespace palp::depth
