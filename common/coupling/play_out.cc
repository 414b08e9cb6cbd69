#include "common/coupling/play_out.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

// A step of the tracker up is 499 times one down: it settles at the 99.8 % quantile.
constexpr double kUpShare = 0.99;
constexpr double kDownShare = 0.002;
constexpr double kStepMin = 0.2e-3;  // [s]
constexpr double kStepShare = 0.02;  // of the delay's spread, per sample
constexpr double kTooOld = 5e-3;     // [s], behind what was played
constexpr double kGapMax = 0.1;      // [s], a longer one is not caught up
constexpr double kKept = 0.2;        // [s], behind what was played: for interpolation

}  // namespace

void PlayOut::restart() noexcept {
  count_ = 0;
  heard_ = false;
  playing_ = false;
  delay_ = 0;
  energy_received_ = 0;
  energy_played_ = 0;
  newest_number_ = 0;
}

void PlayOut::insert(const Point& point) noexcept {
  if (count_ == kPointsMax) {
    std::move(points_.begin() + 1, points_.end(), points_.begin());
    --count_;
  }
  std::size_t at = count_;
  while (at > 0 && points_[at - 1].at > point.at) --at;
  if (at > 0 && points_[at - 1].at == point.at) return;
  std::move_backward(points_.begin() + static_cast<std::ptrdiff_t>(at),
                     points_.begin() + static_cast<std::ptrdiff_t>(count_),
                     points_.begin() + static_cast<std::ptrdiff_t>(count_ + 1));
  points_[at] = point;
  ++count_;
}

void PlayOut::hear(const Incoming& incoming) noexcept {
  const auto* wave = std::get_if<WavePayload>(&incoming.sample.payload);
  if (wave == nullptr || !std::isfinite(wave->wave_integral) || !std::isfinite(wave->wave_energy)) {
    return;
  }
  if (!heard_) {
    heard_ = true;
    sent_first_ = incoming.sent_at;
    arrived_first_ = incoming.arrived_at;
    newest_number_ = incoming.number;
    energy_received_ = wave->wave_energy;
  }
  const double sent = seconds(incoming.sent_at - sent_first_);
  const double offset = seconds(incoming.arrived_at - arrived_first_) - sent;
  if (!incoming.repaired) {
    const double step = std::max(kStepMin, kStepShare * std::abs(delay_));
    delay_ += offset > delay_ ? kUpShare * step : -kDownShare * step;
  }
  if (incoming.number >= newest_number_) {
    newest_number_ = incoming.number;
    energy_received_ = std::max(energy_received_, wave->wave_energy);
  }
  if (playing_ && sent < played_to_ - kTooOld) return;
  insert({sent, wave->wave_integral});
}

double PlayOut::integral_at(double at, bool& in_gap) const noexcept {
  in_gap = false;
  std::size_t after = 0;
  while (after < count_ && points_[after].at <= at) ++after;
  if (after == 0) return points_[0].integral;
  const Point& left = points_[after - 1];
  if (after == count_) {
    in_gap = at - left.at > kGapMax;
    return left.integral;
  }
  const Point& right = points_[after];
  const double span = right.at - left.at;
  in_gap = span > kGapMax;
  return left.integral + (right.integral - left.integral) * (at - left.at) / span;
}

void PlayOut::forget_before(double at) noexcept {
  std::size_t gone = 0;
  while (gone + 1 < count_ && points_[gone + 1].at < at - kKept) ++gone;
  if (gone == 0) return;
  std::move(points_.begin() + static_cast<std::ptrdiff_t>(gone),
            points_.begin() + static_cast<std::ptrdiff_t>(count_),
            points_.begin());
  count_ -= gone;
}

double PlayOut::step(TimePoint now, std::span<const Incoming> arrived) noexcept {
  for (const Incoming& incoming : arrived) hear(incoming);
  if (!heard_ || count_ == 0) return 0;
  const double wanted = seconds(now - arrived_first_) - delay_ - period_;
  const double before = played_to_;
  if (!playing_) {
    playing_ = true;
    played_to_ = wanted;
    return 0;
  }
  played_to_ = std::max(played_to_, wanted);
  bool gap_now = false;
  bool gap_before = false;
  const double to = integral_at(played_to_, gap_now);
  const double from = integral_at(before, gap_before);
  forget_before(played_to_);
  if (gap_now || gap_before) return 0;
  const double room = std::max(0.0, energy_received_ - energy_played_);
  const double largest = std::sqrt(2 * room / period_);
  const double wave = std::clamp((to - from) / period_, -largest, largest);
  energy_played_ += 0.5 * wave * wave * period_;
  return wave;
}

}  // namespace palp::coupling
