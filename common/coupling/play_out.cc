#include "common/coupling/play_out.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::coupling {
namespace {

constexpr double kGrowth = 4e-3;     // [s], of the delay, at most for one pause
constexpr double kShrinkage = 1e-4;  // of the time that passes: 1 ms in 10 s
constexpr double kHaste = 0.1;       // more than real time, when late
constexpr double kLateMax = 5e-3;    // [s], later than this is dropped
constexpr double kTooOld = 5e-3;     // [s], behind what was played
constexpr double kGapMax = 0.1;      // [s], what lies in a longer one is silence
constexpr double kKept = 0.2;        // [s], behind what was played: for interpolation

}  // namespace

void PlayOut::restart() noexcept {
  count_ = 0;
  heard_ = false;
  playing_ = false;
  newest_at_ = 0;
  age_ = 0;
  delay_ = 0;
  played_to_ = 0;
  integral_played_ = 0;
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
  if (incoming.number >= newest_number_) {
    newest_number_ = incoming.number;
    energy_received_ = std::max(energy_received_, wave->wave_energy);
  }
  newest_at_ = std::max(newest_at_, sent);
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

/// `clock` [s] is the age of the first sample now. What counts of a pause is how old the news had
/// become at its end.
void PlayOut::follow_age(double clock) noexcept {
  const double age = clock - newest_at_;
  const double excess = age_ - delay_;
  if (age < age_ && excess > 0 && excess < kGapMax) delay_ += std::min(excess, kGrowth);
  age_ = age;
  delay_ -= kShrinkage * period_;
}

void PlayOut::skip(const HeldWave& held) noexcept {
  energy_played_ += 0.5 * held.wave * held.wave * held.span;
  if (!playing_) return;
  played_to_ = std::clamp(played_to_ + held.span, played_to_, std::max(played_to_, newest_at_));
  bool in_gap = false;
  integral_played_ = integral_at(played_to_, in_gap);
}

double PlayOut::step(TimePoint now,
                     std::span<const Incoming> arrived,
                     const HeldWave& held) noexcept {
  for (const Incoming& incoming : arrived) hear(incoming);
  if (!heard_ || count_ == 0) return 0;
  if (held.span > 0) skip(held);
  const double clock = seconds(now - arrived_first_);
  if (!playing_) {
    playing_ = true;
    age_ = delay_ = clock - newest_at_;
    played_to_ = newest_at_;
    bool in_gap = false;
    integral_played_ = integral_at(played_to_, in_gap);
    return 0;
  }
  follow_age(clock);
  const double wanted = std::min(clock - delay_, newest_at_);
  bool gap_before = false;
  if (wanted > played_to_ + period_ + kLateMax) {
    played_to_ = wanted - period_;
    integral_played_ = integral_at(played_to_, gap_before);
  }
  played_to_ = std::clamp(wanted, played_to_, played_to_ + (1 + kHaste) * period_);
  bool gap_now = false;
  const double to = integral_at(played_to_, gap_now);
  const double from = std::exchange(integral_played_, to);
  forget_before(played_to_);
  if (gap_now || gap_before) return 0;
  const double room = std::max(0.0, energy_received_ - energy_played_);
  const double largest = std::sqrt(2 * room / period_);
  const double wave = std::clamp((to - from) / period_, -largest, largest);
  energy_played_ += 0.5 * wave * wave * period_;
  return wave;
}

}  // namespace palp::coupling
