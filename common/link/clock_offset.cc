#include "common/link/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace palp::link {
namespace {

/// Crystals differ by less: a steeper line is a change of the route.
constexpr double kSkewMax = 500e-6;  // [s/s]
/// How crystals differ, as a standard deviation: where the points scatter much, they are believed
/// less than this.
constexpr double kSkewSpread = 30e-6;  // [s/s]
/// Below this a second is as good as any: wake-ups and stamps scatter as much.
constexpr double kScatter = 2e-6;  // [s]
/// Lines and weights in turn until they agree.
constexpr int kRounds = 8;

struct Point {
  double x{};       ///< [s]
  double y{};       ///< [s]
  double weight{};  ///< [1/s^2]
};

/// The points of one direction, and the line's height above x = 0.
struct Way {
  std::array<Point, ClockOffsetEstimator::kSeconds> points{};
  std::size_t count{};
  double height{};  ///< [s]

  void add(double x, double y) noexcept { points[count++] = {x, y, 1 / (kScatter * kScatter)}; }
  [[nodiscard]] std::span<Point> all() noexcept { return std::span{points}.first(count); }
};

/// Their centre of mass; the weight is that of all.
Point centre_of(std::span<const Point> points) noexcept {
  Point sum;
  for (const Point& point : points) {
    sum.weight += point.weight;
    sum.x += point.weight * point.x;
    sum.y += point.weight * point.y;
  }
  return {sum.x / sum.weight, sum.y / sum.weight, sum.weight};
}

/// Weighted least squares with one slope, `there` rising as `here` falls, and the prior of
/// crystals.
double slope_of(Way& there, Way& here) noexcept {
  double covariance = 0;                              // [s/s]
  double variance = 1 / (kSkewSpread * kSkewSpread);  // [-]
  double sign = 1;
  for (Way* way : {&there, &here}) {
    const Point centre = centre_of(way->all());
    for (const Point& point : way->all()) {
      covariance += sign * point.weight * (point.x - centre.x) * (point.y - centre.y);
      variance += point.weight * (point.x - centre.x) * (point.x - centre.x);
    }
    sign = -1;
  }
  return std::clamp(covariance / variance, -kSkewMax, kSkewMax);
}

/// The height of the line; then weights by the points' scatter and, above it, by their distance.
void place(Way& way, double slope) noexcept {
  const Point centre = centre_of(way.all());
  way.height = centre.y - slope * centre.x;
  std::array<double, ClockOffsetEstimator::kSeconds> distances{};
  const auto end = std::transform(
      way.all().begin(), way.all().end(), distances.begin(), [&](const Point& point) {
        return std::abs(point.y - way.height - slope * point.x);
      });
  const auto middle = distances.begin() + (end - distances.begin()) / 2;
  std::nth_element(distances.begin(), middle, end);
  const double scatter = std::max(kScatter, 2 * *middle);
  for (Point& point : way.all()) {
    const double above = std::max(0.0, point.y - way.height - slope * point.x);
    point.weight = 1 / (scatter * scatter + above * above);
  }
}

std::int64_t second_of(TimePoint at) noexcept {
  return std::chrono::floor<std::chrono::seconds>(at).time_since_epoch().count();
}

}  // namespace

void ClockOffsetEstimator::add(Duration there, Duration here, TimePoint arrived_at) noexcept {
  const std::int64_t second = second_of(arrived_at);
  if (!begun_) {
    begun_ = true;
    newest_ = second;
    origin_ = arrived_at;
    there_origin_ = there_ = there;
    here_origin_ = here_ = here;
  }
  newest_at_ = arrived_at;
  there_ += (there - there_) / 8;
  here_ += (here - here_) / 8;
  if (second > newest_) {
    fit(newest_);
    newest_ = second;
  }
  const double at = seconds(arrived_at - origin_);
  const Least one{seconds(there - there_origin_), at};
  const Least other{seconds(here - here_origin_), at};
  Bin& bin = bins_[static_cast<std::size_t>(((second % kSeconds) + kSeconds) % kSeconds)];
  if (!bin.used || bin.second < second) {
    bin = {second, true, one, other};
  } else if (bin.second == second) {
    if (one.value < bin.there.value) bin.there = one;
    if (other.value < bin.here.value) bin.here = other;
  }
}

Duration ClockOffsetEstimator::way_there() const noexcept {
  return estimate_ ? there_ - estimate_->offset_at(newest_at_) : Duration{};
}

Duration ClockOffsetEstimator::way_here() const noexcept {
  return estimate_ ? here_ + estimate_->offset_at(newest_at_) : Duration{};
}

/// From the seconds up to `until`, whose exchanges are all there.
void ClockOffsetEstimator::fit(std::int64_t until) noexcept {
  Way there;
  Way here;
  for (const Bin& bin : bins_) {
    if (!bin.used || bin.second > until || bin.second <= until - kSeconds) continue;
    there.add(bin.there.at, bin.there.value);
    here.add(bin.here.at, bin.here.value);
  }
  double slope = 0;
  for (int round = 0; round < kRounds; ++round) {
    slope = slope_of(there, here);
    place(there, slope);
    place(here, -slope);
  }
  const double now = static_cast<double>(until + 1) - seconds(origin_.time_since_epoch());
  const Duration apart = there_origin_ - here_origin_;
  const Duration sum = there_origin_ + here_origin_;
  const Duration round_trip = std::max(sum + from_seconds(there.height + here.height), Duration{});
  estimate_ = ClockOffset{
      .offset = apart / 2 + from_seconds(0.5 * (there.height - here.height) + slope * now),
      .skew = slope,
      .uncertainty = round_trip / 2,
      .at = origin_ + from_seconds(now)};
}

}  // namespace palp::link
