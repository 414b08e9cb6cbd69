#include "depth/map_posterior.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/random.h"
#include "depth/map_cells.h"

namespace palp::depth {
namespace {

constexpr std::size_t kDrawsPrior = 240;
constexpr std::size_t kDrawsFirst = 500;   // by the cells' own masses
constexpr std::size_t kDrawsLater = 1700;  // at most, by what these said of them
constexpr double kWorth = 500;             // [-], of even draws: enough
constexpr double kFirstShare = 0.25;       // [-], of the later draws, by the cells' own masses
/// Outside of an interval, by side, and on the lower side where the interval reaches the upper end.
struct Tails {
  double low{};          ///< [-], share
  double high{};         ///< [-]
  double low_to_end{};   ///< [-]
  double high_to_end{};  ///< [-], and on the upper side where it reaches the lower end
};
constexpr Tails kEven{.low = 0.025, .high = 0.025, .low_to_end = 0.05, .high_to_end = 0.05};
// Of the radius: a large ball is seen from more places and depths than a small one, and has more of
// the posterior where the touches tell little of the size. Small ones are left in longer.
constexpr Tails kOfRadius{.low = 0.005, .high = 0.045, .low_to_end = 0.005, .high_to_end = 0.05};
constexpr double kEnd = 0.08;             // [-], of a range: near its end
constexpr double kModeShare = 0.02;       // [-]: less is no mode
constexpr double kForgottenShare = 1e-9;  // [-], share of a ball
constexpr std::uint64_t kSeed = 0x6d6170;
constexpr double kNone = -std::numeric_limits<double>::infinity();

double log_sum(double a, double b) noexcept {
  const double most = std::max(a, b);
  return most > kNone ? most + std::log(std::exp(a - most) + std::exp(b - most)) : kNone;
}

/// Balls drawn from the cells and from the prior, weighed by the likelihood.
class Sampler {
 public:
  Sampler(const MapLikelihood& likelihood, const BallPrior& prior, std::vector<BallCell> cells)
      : likelihood_{likelihood}, prior_{prior}, cells_{std::move(cells)} {}

  struct Drawn {
    MapBall ball;
    double value{};    ///< likelihood and prior, logarithm
    double density{};  ///< of all that was drawn from, logarithm
    std::size_t mode{};
  };

  std::vector<Drawn> run() {
    draw_prior();
    std::vector<double> masses;
    for (const BallCell& cell : cells_) masses.push_back(cell.mass);
    draw_cells(kDrawsFirst, masses);
    const std::vector<double> found = weigh_cells();
    const double wanted = (kWorth / worth() - 1) * static_cast<double>(drawn_.size());
    const double before = total(masses);
    const double now = total(found);
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const double share =
          kFirstShare * std::exp(masses[c] - before) + (1 - kFirstShare) * std::exp(found[c] - now);
      masses[c] = std::log(share + 1e-9);
    }
    draw_cells(static_cast<std::size_t>(std::clamp<double>(wanted, 0, kDrawsLater)), masses);
    for (Drawn& one : drawn_) measure(one);
    return std::move(drawn_);
  }

 private:
  static double total(const std::vector<double>& masses) noexcept {
    double sum = kNone;
    for (const double mass : masses) sum = log_sum(sum, mass);
    return sum;
  }

  void keep(const MapBall& ball) {
    const double prior = prior_.log_density(ball);
    if (prior > kNone) drawn_.push_back({.ball = ball, .value = likelihood_.at(ball) + prior});
  }

  void draw_prior() {
    const RandomStream random{kSeed, 1};
    for (std::size_t i = 0; i < kDrawsPrior; ++i) keep(prior_.draw(i, random.uniform(i)));
  }

  /// At least one of each cell.
  void draw_cells(std::size_t count, const std::vector<double>& masses) {
    const RandomStream random{kSeed, 2};
    const double all = total(masses);
    if (counts_.empty()) counts_.resize(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const BallCell& cell = cells_[c];
      const double wanted = static_cast<double>(count) * std::exp(masses[c] - all);
      const auto more = 1 + static_cast<std::size_t>(std::round(wanted));
      for (std::size_t i = counts_[c]; i < counts_[c] + more; ++i) {
        const std::uint64_t at = 5 * draws_++;
        const double chi_square =
            -2 * std::log((1 - random.uniform(at + 3)) * (1 - random.uniform(at + 4)));
        keep(cell.draw(cell.radius + cell.radius_width * (even_number(i, 2) - 0.5),
                       cell.log_ratio + cell.ratio_width * (even_number(i, 3) - 0.5),
                       {random.normal(at), random.normal(at + 1), random.normal(at + 2)},
                       chi_square));
      }
      counts_[c] += more;
    }
  }

  void measure(Drawn& one) const noexcept {
    double sum = kDrawsPrior * prior_.draw_density(one.ball);
    double most = 0;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (!cells_[c].holds(one.ball)) continue;
      const double here =
          static_cast<double>(counts_[c]) * std::exp(cells_[c].log_density(one.ball));
      sum += here;
      if (here < most) continue;
      most = here;
      one.mode = cells_[c].mode;
    }
    one.density = std::log(sum);
  }

  /// So many even draws say as much as the weighed ones so far.
  [[nodiscard]] double worth() const noexcept {
    double most = kNone;
    for (const Drawn& one : drawn_) most = std::max(most, one.value - one.density);
    double sum = 0;
    double squares = 0;
    for (const Drawn& one : drawn_) {
      const double share = std::exp(one.value - one.density - most);
      sum += share;
      squares += share * share;
    }
    return sum * sum / squares;
  }

  /// What the draws so far say of each cell's mass.
  std::vector<double> weigh_cells() {
    std::vector<double> masses(cells_.size(), kNone);
    for (Drawn& one : drawn_) {
      measure(one);
      for (std::size_t c = 0; c < cells_.size(); ++c) {
        if (cells_[c].mode != one.mode || !cells_[c].holds(one.ball)) continue;
        masses[c] = log_sum(masses[c], one.value - one.density);
        break;
      }
    }
    return masses;
  }

  const MapLikelihood& likelihood_;
  const BallPrior& prior_;
  std::vector<BallCell> cells_;
  std::vector<std::size_t> counts_;  ///< draws, by cell
  std::uint64_t draws_{};
  std::vector<Drawn> drawn_;
};

struct WeighedValue {
  double value{};
  double share{};  // [-]
};

/// Of a coordinate between two ends; 5 % outside the interval, on one side alone where the
/// likeliest value is an end: the truth may lie there.
template <class Value>
Estimated estimated(const std::vector<LikelyBall>& balls,
                    double low,
                    double high,
                    const Tails& tails,
                    const Value& value) {
  std::vector<WeighedValue> all;
  all.reserve(balls.size());
  Estimated out;
  double mean = 0;
  for (const LikelyBall& one : balls) {
    all.push_back({value(one.ball), one.share});
    mean += one.share * all.back().value;
  }
  double square = 0;
  for (const WeighedValue& one : all) square += one.share * (one.value - mean) * (one.value - mean);
  out.stddev = std::sqrt(square);
  std::sort(all.begin(), all.end(), [](const WeighedValue& a, const WeighedValue& b) {
    return a.value < b.value;
  });
  const auto quantile = [&](double share) {
    double sum = 0;
    for (const WeighedValue& one : all) {
      sum += one.share;
      if (sum >= share) return one.value;
    }
    return all.back().value;
  };
  out.median = quantile(0.5);
  out.low = quantile(tails.low);
  out.high = quantile(1 - tails.high);
  // Densities near the ends beside the largest anywhere.
  const double window = kEnd * (high - low);
  const auto within = [&](double from) {
    double sum = 0;
    for (const WeighedValue& one : all) {
      if (one.value >= from && one.value <= from + window) sum += one.share;
    }
    return sum;
  };
  if (!(window > 0)) return out;
  double most = 0;
  double from = low + window;
  while (from + window < high) {
    most = std::max(most, within(from));
    from += 0.5 * window;
  }
  const double first = within(low);
  const double last = within(high - window);
  if (std::max(first, last) < most) return out;
  if (first > last) {
    out.low = low;
    out.high = quantile(1 - tails.high_to_end);
  } else {
    out.low = quantile(tails.low_to_end);
    out.high = high;
  }
  return out;
}

void find_modes(const std::vector<Sampler::Drawn>& drawn,
                const std::vector<double>& shares,
                MapPosterior& out) {
  std::vector<MapMode> modes(kModesMax);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    MapMode& mode = modes[drawn[i].mode];
    mode.share += shares[i];
    mode.place.x += shares[i] * drawn[i].ball.place.x;
    mode.place.y += shares[i] * drawn[i].ball.place.y;
  }
  for (MapMode& mode : modes) {
    if (mode.share < kModeShare) continue;
    mode.place = {mode.place.x / mode.share, mode.place.y / mode.share};
    out.modes.push_back(mode);
  }
  std::sort(out.modes.begin(), out.modes.end(), [](const MapMode& a, const MapMode& b) {
    return a.share > b.share;
  });
}

}  // namespace

MapPosterior map_posterior(const MapLikelihood& likelihood,
                           const BallField& field,
                           const MapPrior& prior) {
  const BallPrior given{prior, likelihood.places()};
  const auto drawn = Sampler{likelihood, given, ball_cells(likelihood, field, given)}.run();
  MapPosterior out;
  double most = kNone;
  double best = kNone;
  for (const Sampler::Drawn& one : drawn) {
    most = std::max(most, one.value - one.density);
    if (one.value <= best) continue;
    best = one.value;
    out.best = one.ball;
  }
  std::vector<double> shares;
  double total = 0;
  double squares = 0;
  for (const Sampler::Drawn& one : drawn) {
    shares.push_back(std::exp(one.value - one.density - most));
    total += shares.back();
    squares += shares.back() * shares.back();
  }
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    shares[i] /= total;
    if (shares[i] < kForgottenShare) continue;
    out.balls.push_back({drawn[i].ball, shares[i]});
    mean_x += shares[i] * drawn[i].ball.place.x;
    mean_y += shares[i] * drawn[i].ball.place.y;
  }
  for (const LikelyBall& one : out.balls) {
    out.covariance += one.share * (one.ball.place.x - mean_x) * (one.ball.place.y - mean_y);
  }
  out.balls_worth = total * total / squares;
  out.log_evidence = most + std::log(total) - given.log_total() - likelihood.plain();
  out.gain = 2 * (likelihood.at(out.best) - likelihood.plain());
  find_modes(drawn, shares, out);
  const DepthPrior& ball = prior.ball;
  out.x = estimated(out.balls, 0, 0, kEven, [](const MapBall& one) { return one.place.x; });
  out.y = estimated(out.balls, 0, 0, kEven, [](const MapBall& one) { return one.place.y; });
  out.depth = estimated(out.balls, ball.depth_min, ball.depth_max, kEven, [](const MapBall& one) {
    return std::exp(one.log_depth);
  });
  out.radius =
      estimated(out.balls, ball.radius_min, ball.radius_max, kOfRadius, [](const MapBall& one) {
        return one.radius;
      });
  out.ratio = estimated(
      out.balls, std::log(ball.ratio_min), std::log(ball.ratio_max), kEven, [](const MapBall& one) {
        return one.log_ratio;
      });
  out.ratio = {std::exp(out.ratio.median),
               std::exp(out.ratio.low),
               std::exp(out.ratio.high),
               std::exp(out.ratio.median) * out.ratio.stddev};
  return out;
}

}  // namespace palp::depth
