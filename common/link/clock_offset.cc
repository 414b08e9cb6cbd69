#include "common/link/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <numeric>
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
/// Half of all lie within 0.67 standard deviations, here half the scatter.
constexpr double kDeviationPerScatter = 0.5 / 0.6745;
/// Jitter remembers itself for longer than this: a denser look says nothing more.
constexpr double kKeptEvery = 4e-3;  // [s]
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
  double height{};   ///< [s]
  double scatter{};  ///< [s], of a point about the line, as a standard deviation

  void add(double x, double y) noexcept { points[count++] = {x, y, 1 / (kScatter * kScatter)}; }
  [[nodiscard]] std::span<Point> all() noexcept { return std::span{points}.first(count); }
};

/// Both directions, and what is read off their lines.
struct Lines {
  Way there;
  Way here;
  double slope{};   ///< [s/s]
  double offset{};  ///< [s], at the time asked for
  double error{};   ///< [s], of it, as a standard deviation
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
  way.scatter = scatter * kDeviationPerScatter;
  for (Point& point : way.all()) {
    const double above = std::max(0.0, point.y - way.height - slope * point.x);
    point.weight = 1 / (scatter * scatter + above * above);
  }
}

void lay(Lines& lines, double now) noexcept {
  for (int round = 0; round < kRounds; ++round) {
    lines.slope = slope_of(lines.there, lines.here);
    place(lines.there, lines.slope);
    place(lines.here, -lines.slope);
  }
  lines.offset = 0.5 * (lines.there.height - lines.here.height) + lines.slope * now;
  double information = 1 / (kSkewSpread * kSkewSpread);  // on the slope
  double variance = 0;
  double reach = 0;  // [s], from the middle of the points to now
  for (Way* way : {&lines.there, &lines.here}) {
    const Point centre = centre_of(way->all());
    const double square = way->scatter * way->scatter;
    variance += 0.25 * square / static_cast<double>(way->count);
    reach += 0.5 * (now - centre.x);
    for (const Point& point : way->all()) {
      information += (point.x - centre.x) * (point.x - centre.x) / square;
    }
  }
  lines.error = std::sqrt(variance + reach * reach / information);
}

/// What the middles would be wrong by where one direction is spread more than the other, as far as
/// it shows behind what is not known of the edges.
double lean_of(const Lines& edges, const Lines& middles) noexcept {
  const double lean = 0.5 * ((middles.there.height - edges.there.height) -
                             (middles.here.height - edges.here.height));
  return std::max(0.0, std::abs(lean) - std::hypot(edges.error, middles.error));
}

/// Mean of the middle half: scatters less than the median, and outliers do not move it either.
double middle_of(std::span<double> values) noexcept {
  const auto from = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  const auto to = values.end() - static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), from, values.end());
  if (to != values.end()) std::nth_element(from, to, values.end());
  return std::accumulate(from, to, 0.0) / static_cast<double>(to - from);
}

std::size_t index_of(std::int64_t second) noexcept {
  constexpr std::int64_t kSeconds = ClockOffsetEstimator::kSeconds;
  return static_cast<std::size_t>(((second % kSeconds) + kSeconds) % kSeconds);
}

std::int64_t second_of(TimePoint at) noexcept {
  return std::chrono::floor<std::chrono::seconds>(at).time_since_epoch().count();
}

}  // namespace

void ClockOffsetEstimator::add(Duration there, Duration here, TimePoint arrived_at) noexcept {
  const std::int64_t number = second_of(arrived_at);
  if (!begun_) {
    begun_ = true;
    newest_ = number;
    origin_ = arrived_at;
    there_origin_ = there_ = there;
    here_origin_ = here_ = here;
  }
  newest_at_ = arrived_at;
  there_ += (there - there_) / 8;
  here_ += (here - here_) / 8;
  if (number > newest_) {
    end_second();
    fit(newest_);
    newest_ = number;
  }
  const double at = seconds(arrived_at - origin_);
  const Ways ways{{seconds(there - there_origin_), at}, {seconds(here - here_origin_), at}};
  Second& second = seconds_[index_of(number)];
  if (!second.used || second.number < number) {
    second = {number, true, ways, ways};
  } else if (second.number == number) {
    if (ways.there.value < second.least.there.value) second.least.there = ways.there;
    if (ways.here.value < second.least.here.value) second.least.here = ways.here;
  }
  const bool due = kept_.count == 0 || at - kept_.newest_at >= kKeptEvery;
  if (number != newest_ || !due || kept_.count == Kept::kMax) return;
  kept_.there[kept_.count] = ways.there.value;
  kept_.here[kept_.count] = ways.here.value;
  ++kept_.count;
  kept_.newest_at = at;
}

/// The middles of the second that was the newest one.
void ClockOffsetEstimator::end_second() noexcept {
  Second& second = seconds_[index_of(newest_)];
  if (kept_.count > 0 && second.number == newest_) {
    const double centre = static_cast<double>(newest_) + 0.5 - seconds(origin_.time_since_epoch());
    second.middle.there = {middle_of(std::span{kept_.there}.first(kept_.count)), centre};
    second.middle.here = {middle_of(std::span{kept_.here}.first(kept_.count)), centre};
  }
  kept_.count = 0;
}

Duration ClockOffsetEstimator::way_there() const noexcept {
  return estimate_ ? there_ - estimate_->offset_at(newest_at_) : Duration{};
}

Duration ClockOffsetEstimator::way_here() const noexcept {
  return estimate_ ? here_ + estimate_->offset_at(newest_at_) : Duration{};
}

/// From the seconds up to `until`, whose exchanges are all there.
void ClockOffsetEstimator::fit(std::int64_t until) noexcept {
  Lines edges;
  Lines middles;
  for (const Second& second : seconds_) {
    if (!second.used || second.number > until || second.number <= until - kSeconds) continue;
    edges.there.add(second.least.there.at, second.least.there.value);
    edges.here.add(second.least.here.at, second.least.here.value);
    middles.there.add(second.middle.there.at, second.middle.there.value);
    middles.here.add(second.middle.here.at, second.middle.here.value);
  }
  const double now = static_cast<double>(until + 1) - seconds(origin_.time_since_epoch());
  lay(edges, now);
  lay(middles, now);
  const double risk = std::hypot(middles.error, lean_of(edges, middles));
  const double share = edges.error * edges.error / (edges.error * edges.error + risk * risk);
  const auto mixed = [share](double of_edges, double of_middles) {
    return of_edges + share * (of_middles - of_edges);
  };
  const Duration apart = there_origin_ - here_origin_;
  const Duration sum = there_origin_ + here_origin_;
  const double least = edges.there.height + edges.here.height;
  estimate_ = ClockOffset{.offset = apart / 2 + from_seconds(mixed(edges.offset, middles.offset)),
                          .skew = mixed(edges.slope, middles.slope),
                          .uncertainty = std::max(sum + from_seconds(least), Duration{}) / 2,
                          .at = origin_ + from_seconds(now)};
}

}  // namespace palp::link
