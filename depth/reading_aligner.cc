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

ReadingAligner::Seen ReadingAligner::tip_at(TimePoint at) {
  constexpr Seen kNotYet{.tip = {}, .ever = true};
  constexpr Seen kNever{.tip = {}, .ever = false};
  while (tips_.size() > 2 && tips_[2].at <= at) tips_.pop_front();
  if (tips_.front().at > at) return kNever;
  const auto after = std::ranges::find_if(tips_, [&](const Reading& one) { return one.at >= at; });
  if (after == tips_.end()) return kNotYet;
  if (after->at == at) return {.tip = after->value};
  const auto index = static_cast<std::size_t>(after - tips_.begin());
  if (seconds(tips_[index].at - tips_[index - 1].at) > gap_of(config_.stage_rate)) return kNever;
  if (index + 1 == tips_.size()) return kNotYet;
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
  return {.tip = between(times, values, 0)};
}

void ReadingAligner::give_up() noexcept {
  forces_.pop_front();
  begun_ = false;
}

std::optional<AlignedSample> ReadingAligner::next_step() {
  const Reading& from = forces_[0];
  const Reading& to = forces_[1];
  const double span = seconds(to.at - from.at);
  if (span > gap_of(config_.sensor_rate)) {
    give_up();
    return take();
  }
  const auto steps =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(span / config_.period)));
  const bool last = steps_done_ + 1 == steps;
  const double share = static_cast<double>(steps_done_ + 1) / static_cast<double>(steps);
  const TimePoint at = last ? to.at : from.at + from_seconds(share * span);
  const Seen seen = tip_at(at);
  if (!seen.ever) {
    give_up();
    return take();
  }
  if (!seen.tip) return std::nullopt;
  const double force = last ? to.value : from.value + share * (to.value - from.value);
  const AlignedSample out{{.at = at, .position = *seen.tip, .force = force, .place = to.place},
                          last};
  steps_done_ = last ? 0 : steps_done_ + 1;
  if (last) forces_.pop_front();
  return out;
}

std::optional<AlignedSample> ReadingAligner::take() {
  while (!begun_ && !forces_.empty()) {  // the first of all, or behind a gap
    const Reading first = forces_.front();
    const Seen seen = tip_at(first.at);
    if (!seen.ever) {
      forces_.pop_front();
      continue;
    }
    if (!seen.tip) return std::nullopt;
    begun_ = true;
    steps_done_ = 0;
    return AlignedSample{
        {.at = first.at, .position = *seen.tip, .force = first.value, .place = first.place}, true};
  }
  return forces_.size() < 2 ? std::nullopt : next_step();
}

}  // namespace palp::depth
