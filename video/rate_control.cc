#include "video/rate_control.h"

#include <algorithm>
#include <cmath>

namespace palp::video {
namespace {

using std::chrono::milliseconds;

// Found in virtual time over bottlenecks of 1.9 to 100 Mbit/s; tests/lab/video_path_test.cc holds
// what they achieve.
constexpr Duration kYieldAbove = milliseconds{4};
constexpr Duration kYieldMuchAbove = milliseconds{8};
constexpr Duration kGrowBelow = std::chrono::microseconds{1500};
constexpr Duration kPauseAbove = milliseconds{15};
constexpr Duration kPause = milliseconds{40};
constexpr double kLossMax = 0.15;
constexpr double kSpreadMuch = 1.12;    // of a frame on its way
constexpr double kSpreadLittle = 1.05;  // likewise
constexpr double kPaceMin = 600;        // [kbit/s]
constexpr double kPaceMax = 9600;       // [kbit/s]
constexpr Duration kForgetCeiling = std::chrono::seconds{20};
constexpr Duration kOffMax = std::chrono::seconds{60};
constexpr Duration kOffFirst = std::chrono::seconds{5};
constexpr int kCutsBeforeOff = 4;
constexpr double kFrozenMax = 0.005;  // share of time
constexpr double kRecovery = 0.05;    // [s], beyond a round trip
constexpr double kFps = 30;           // [1/s]

/// P(more than `spare` of `count` lost).
double chance_of_more(std::size_t count, std::size_t spare, double loss) noexcept {
  double term = std::pow(1 - loss, static_cast<double>(count));
  double sum = 0;
  for (std::size_t i = 0; i <= spare; ++i) {
    sum += term;
    term *= static_cast<double>(count - i) / static_cast<double>(i + 1) * loss / (1 - loss);
  }
  return 1 - sum;
}

}  // namespace

void RateControl::hear(const Report& report, Duration round_trip, TimePoint now) noexcept {
  const double lost = report.lost / 65535.0;
  loss_ += (lost > loss_ ? 0.3 : 0.02) * (lost - loss_);
  const Duration standing = std::chrono::microseconds{10} * report.standing_10us;
  if (standing > kPauseAbove) paused_until_ = std::max(paused_until_, now + kPause);
  if (standing > kYieldAbove || loss_ > kLossMax) {
    yield(standing, round_trip, now);
  } else if (standing < kGrowBelow) {
    grow(round_trip, now);
  }
  set_pace(report);
}

void RateControl::yield(Duration standing, Duration round_trip, TimePoint now) noexcept {
  if (off(now)) return;
  if (cut_at_ && now - *cut_at_ <= round_trip + milliseconds{150}) return;
  ceiling_ = target_;
  target_ = std::max(config_.min_kbps, target_ * (standing > kYieldMuchAbove ? 0.6 : 0.85));
  cut_at_ = now;
  if (target_ > config_.min_kbps || ++cuts_at_least_ < kCutsBeforeOff) return;
  cuts_at_least_ = 0;
  off_until_ = now + off_for_;
  off_for_ = std::min(kOffMax, 2 * off_for_);
}

void RateControl::grow(Duration round_trip, TimePoint now) noexcept {
  if (off(now)) return;
  if (cut_at_ && now - *cut_at_ <= round_trip + milliseconds{300}) return;
  if (grown_at_ && now - *grown_at_ <= milliseconds{100}) return;
  grown_at_ = now;
  cuts_at_least_ = 0;
  const bool near = ceiling_ && target_ > 0.9 * *ceiling_;
  if (cut_at_ && now - *cut_at_ > kForgetCeiling) {
    ceiling_.reset();
    off_for_ = kOffFirst;
  }
  target_ = std::min(config_.max_kbps, target_ * (near ? 1.002 : 1.03) + 0.5);
}

/// Fragments that arrive further apart than they left met a line that is slower than the pace.
void RateControl::set_pace(const Report& report) noexcept {
  const double ratio = report.span_ratio / 256.0;
  if (ratio > kSpreadMuch) {
    narrow_ = true;
    pace_ = std::min(pace_, std::max(1.2 * target_, 0.85 * report.rate_kbps));
  } else if (ratio < kSpreadLittle) {
    pace_ *= narrow_ ? 1.015 : 1.04;  // quickly, until a line is met for the first time
  }
  pace_ = std::clamp(pace_, kPaceMin, kPaceMax);
}

int RateControl::stride() const noexcept {
  if (target_ < 150) return 4;
  return target_ < 300 ? 2 : 1;
}

std::size_t ParityPlan::count(std::size_t data, double loss, Duration round_trip) const noexcept {
  std::size_t count = std::min(lost_of_frame_, data + 1);
  if (loss > 0.0005) {
    const double known = std::min(0.3, loss);
    const double away = std::chrono::duration<double>(round_trip).count() + kRecovery;
    const double failures = kFrozenMax / (kFps * away);
    while (count < data + 1 && chance_of_more(data + count, count, known) > failures) ++count;
  }
  return std::min(count, kFragmentsMax - data);
}

}  // namespace palp::video
