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
constexpr Duration kKeptEvery = std::chrono::milliseconds{4};
/// Where half the differences are known so much better than each way, both ways moved together; by
/// chance they never are.
constexpr double kMuchLess = 0.2;  // [-]
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

/// The height of the line; then weights by the points' scatter and, beyond it, by their distance:
/// above the line, or on both of its sides.
void place(Way& way, double slope, bool both_sides = false) noexcept {
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
    const double off = point.y - way.height - slope * point.x;
    const double beyond = both_sides ? off : std::max(0.0, off);
    point.weight = 1 / (scatter * scatter + beyond * beyond);
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

/// The line through half the differences of both directions, second by second: whatever lengthens
/// both ways alike, another route or another satellite, is not in them.
void lay_halves(Lines& lines, double now) noexcept {
  Way halves;
  for (std::size_t i = 0; i < lines.there.count; ++i) {
    const Point& there = lines.there.points[i];
    const Point& here = lines.here.points[i];
    halves.add(0.5 * (there.x + here.x), 0.5 * (there.y - here.y));
  }
  double slope = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Point centre = centre_of(halves.all());
    double covariance = 0;
    double variance = 1 / (kSkewSpread * kSkewSpread);
    for (const Point& point : halves.all()) {
      covariance += point.weight * (point.x - centre.x) * (point.y - centre.y);
      variance += point.weight * (point.x - centre.x) * (point.x - centre.x);
    }
    slope = std::clamp(covariance / variance, -kSkewMax, kSkewMax);
    place(halves, slope, true);
  }
  const Point centre = centre_of(halves.all());
  const double square = halves.scatter * halves.scatter;
  double information = 1 / (kSkewSpread * kSkewSpread);
  for (const Point& point : halves.all()) {
    information += (point.x - centre.x) * (point.x - centre.x) / square;
  }
  const double reach = now - centre.x;
  const double error =
      std::sqrt(square / static_cast<double>(halves.count) + reach * reach / information);
  if (error >= kMuchLess * lines.error) return;
  lines.slope = slope;
  lines.offset = halves.height + slope * now;
  lines.error = error;
}

/// What the middles would be wrong by where one direction is spread more than the other, as far as
/// it shows behind what is not known of the edges. Now, not where the lines began: there, hours
/// ago, the least difference of their slopes would be a gulf.
double lean_of(const Lines& edges, const Lines& middles) noexcept {
  const double lean = middles.offset - edges.offset;
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

}  // namespace

void ClockOffsetEstimator::Direction::add(Duration way,
                                          Duration tick,
                                          TimePoint arrived_at,
                                          double at) noexcept {
  if (!begun) {
    begun = true;
    origin = smoothed = way;
  }
  smoothed += (way - smoothed) / 8;
  const Way one{seconds(way - origin), at};
  const std::int64_t number = second_of(arrived_at);
  Second& second = bins[index_of(number)];
  if (!second.used || second.number < number) {
    second = {number, true, one, one};
  } else if (second.number == number && one.value < second.least.value) {
    second.least = one;
  }
  if (count == kKeptMax || (count > 0 && tick - kept_at < kKeptEvery)) return;
  kept[count++] = one.value;
  kept_at = tick;
}

/// The middle of the second that was the newest one.
void ClockOffsetEstimator::Direction::end_second(std::int64_t number, double centre) noexcept {
  Second& second = bins[index_of(number)];
  if (count > 0 && second.number == number) {
    second.middle = {middle_of(std::span{kept}.first(count)), centre};
  }
  count = 0;
}

void ClockOffsetEstimator::begin_or_end_second(TimePoint arrived_at) noexcept {
  const std::int64_t number = second_of(arrived_at);
  if (!begun_) {
    begun_ = true;
    newest_ = number;
    origin_ = arrived_at;
  }
  newest_at_ = arrived_at;
  if (number <= newest_) return;
  const double centre = static_cast<double>(newest_) + 0.5 - seconds(origin_.time_since_epoch());
  there_.end_second(newest_, centre);
  here_.end_second(newest_, centre);
  fit(newest_);
  newest_ = number;
}

void ClockOffsetEstimator::add_there(Duration way, Duration tick, TimePoint arrived_at) noexcept {
  begin_or_end_second(arrived_at);
  there_.add(way, tick, arrived_at, seconds(arrived_at - origin_));
}

void ClockOffsetEstimator::add_here(Duration way, TimePoint tick, TimePoint arrived_at) noexcept {
  begin_or_end_second(arrived_at);
  here_.add(way, tick.time_since_epoch(), arrived_at, seconds(arrived_at - origin_));
}

Duration ClockOffsetEstimator::delay_out() const noexcept {
  return estimate_ ? there_.smoothed - estimate_->offset_at(newest_at_) : Duration{};
}

Duration ClockOffsetEstimator::delay_in() const noexcept {
  return estimate_ ? here_.smoothed + estimate_->offset_at(newest_at_) : Duration{};
}

/// From the seconds up to `until`, whose exchanges are all there.
void ClockOffsetEstimator::fit(std::int64_t until) noexcept {
  Lines edges;
  Lines middles;
  for (std::size_t i = 0; i < there_.bins.size(); ++i) {
    const Second& there = there_.bins[i];
    const Second& here = here_.bins[i];
    const bool both = there.used && here.used && there.number == here.number;
    if (!both || there.number > until || there.number <= until - kSeconds) continue;
    edges.there.add(there.least.at, there.least.value);
    edges.here.add(here.least.at, here.least.value);
    middles.there.add(there.middle.at, there.middle.value);
    middles.here.add(here.middle.at, here.middle.value);
  }
  if (edges.there.count == 0) return;
  const double now = static_cast<double>(until + 1) - seconds(origin_.time_since_epoch());
  lay(edges, now);
  lay(middles, now);
  lay_halves(edges, now);
  lay_halves(middles, now);
  const double risk = std::hypot(middles.error, lean_of(edges, middles));
  const double share = edges.error * edges.error / (edges.error * edges.error + risk * risk);
  const auto mixed = [share](double of_edges, double of_middles) {
    return of_edges + share * (of_middles - of_edges);
  };
  const Duration apart = there_.origin - here_.origin;
  const Duration sum = there_.origin + here_.origin;
  const double least = edges.there.height + edges.here.height;
  estimate_ = ClockOffset{.offset = apart / 2 + from_seconds(mixed(edges.offset, middles.offset)),
                          .skew = mixed(edges.slope, middles.slope),
                          .uncertainty = std::max(sum + from_seconds(least), Duration{}) / 2,
                          .at = origin_ + from_seconds(now)};
}

}  // namespace palp::link
