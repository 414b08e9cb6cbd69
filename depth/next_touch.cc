#include "depth/next_touch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "depth/seen_balls.h"

namespace palp::depth {
namespace {

constexpr double kGrid = 4e-3;         // [m]
constexpr double kRound = 12e-3;       // [m], farther than that from every touch nothing is sought
constexpr double kTouchError = 0.008;  // [-], of the force, of one touch
constexpr std::size_t kEachOf = 3;     // so many of the seen balls are one here
constexpr double kShareLeast = 5e-3;   // [-], a guess less likely foretells nothing
constexpr double kBin = kTouchError;   // [-], of the logarithm of a force
constexpr double kTailEnd = 3;         // [-], standard deviations
constexpr double kShareNone = 1e-9;    // [-]
constexpr double kRangeMost = 50;      // [-], of the logarithm: what is farther apart is no force

using ByGuess = StiffnessField::ByGuess;

double dot(const double* one, const double* other, std::size_t count) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += one[i] * other[i];
  return sum;
}

/// What balls and guesses of the field foretell of a touch that was not made. The tissue's level is
/// left open, the shape of its curve and the rate factor are as found. Rasmussen and Williams,
/// Gaussian Processes for Machine Learning (2006), eqs. 2.25 to 2.27 and 2.42.
class Forecast {
 public:
  Forecast(const MapLikelihood& likelihood, const BallField& field, const MapPosterior& posterior)
      : likelihood_{likelihood}, count_{likelihood.places().size()} {
    std::vector<double> unit(count_ * count_);
    for (std::size_t i = 0; i < count_; ++i) unit[i * count_ + i] = 1;
    whitened_ = likelihood.differs().whiten(likelihood.rest(&posterior.best).own, count_, unit);
    const std::vector<double> ones(count_, 1.0);
    for (std::size_t guess = 0; guess < levels_.size(); ++guess) {
      levels_[guess] = white(guess, ones);
      level_information_[guess] = dot(levels_[guess].data(), levels_[guess].data(), count_);
    }
    const auto balls = seen_balls(field, posterior);
    for (std::size_t i = kEachOf / 2; i < balls.size(); i += kEachOf) add(balls[i]);
  }

  [[nodiscard]] double gain(const Place& place) const {
    const auto& touched = likelihood_.places();
    const auto near = [&](const PlaceData& one) {
      return distance(one.place, place) <= kSamePlace;
    };
    if (std::any_of(touched.begin(), touched.end(), near)) return 0;
    std::array<std::vector<double>, StiffnessField::kGuesses> alike;
    ByGuess stddev{};
    for (std::size_t guess = 0; guess < alike.size(); ++guess) {
      const FieldGuess& field = likelihood_.differs().guess(guess);
      const double all = field.spread * field.spread;
      std::vector<double> covariance;
      covariance.reserve(count_);
      for (const PlaceData& one : touched) {
        covariance.push_back(all * field.correlation(one.place, place));
      }
      alike[guess] = white(guess, covariance);
      const double level = 1 - dot(alike[guess].data(), levels_[guess].data(), count_);
      const double open = all - dot(alike[guess].data(), alike[guess].data(), count_) +
                          level * level / level_information_[guess];
      stddev[guess] = std::sqrt(std::max(open, 0.0) + kTouchError * kTouchError);
    }
    std::vector<Expected> expected;
    for (std::size_t b = 0; b < balls_.size(); ++b) {
      const Ball& ball = balls_[b];
      const double ratio = ball.seen.log_ratio(place);
      for (std::size_t guess = 0; guess < alike.size(); ++guess) {
        if (ball.share[guess] < kShareLeast) continue;
        const double own = dot(alike[guess].data(), ball.left[guess].data(), count_);
        expected.push_back({b, ratio + ball.level[guess] + own, stddev[guess], ball.share[guess]});
      }
    }
    return information(expected);
  }

 private:
  struct Ball {
    SeenBall seen;
    ByGuess share{};  ///< [-], together 1
    ByGuess level{};  ///< [-], of the tissue, logarithm
    std::array<std::vector<double>, StiffnessField::kGuesses> left{};  ///< white, by touched place
  };
  struct Expected {
    std::size_t ball{};
    double mean{};    ///< [-], logarithm of the force over that of the tissue
    double stddev{};  ///< [-]
    double share{};   ///< [-], of the ball
  };

  [[nodiscard]] std::vector<double> white(std::size_t guess,
                                          const std::vector<double>& values) const {
    const std::span<const double> root = whitened_.of(guess);
    std::vector<double> out;
    out.reserve(count_);
    // Lower triangular.
    for (std::size_t i = 0; i < count_; ++i)
      out.push_back(dot(&root[i * count_], values.data(), i + 1));
    return out;
  }

  void add(const SeenBall& seen) {
    std::vector<double> shown;
    for (std::size_t i = 0; i < count_; ++i) {
      shown.push_back(likelihood_.excess()[i].value -
                      seen.log_ratio(likelihood_.places()[i].place));
    }
    Ball ball;
    ball.seen = seen;
    ball.share = likelihood_.guesses(seen.ball);
    for (std::size_t guess = 0; guess < ball.left.size(); ++guess) {
      if (ball.share[guess] < kShareLeast) continue;
      ball.left[guess] = white(guess, shown);
      std::vector<double>& left = ball.left[guess];
      ball.level[guess] =
          dot(left.data(), levels_[guess].data(), count_) / level_information_[guess];
      for (std::size_t i = 0; i < count_; ++i) left[i] -= ball.level[guess] * levels_[guess][i];
    }
    balls_.push_back(std::move(ball));
  }

  /// The entropy of the force less that which is left where the ball is known.
  [[nodiscard]] double information(const std::vector<Expected>& expected) const {
    if (expected.empty()) return 0;
    double low = expected.front().mean;
    double high = low;
    for (const Expected& one : expected) {
      low = std::min(low, one.mean - kTailEnd * one.stddev);
      high = std::max(high, one.mean + kTailEnd * one.stddev);
    }
    if (!(high - low < kRangeMost)) return 0;
    const auto bins = static_cast<std::size_t>((high - low) / kBin) + 1;
    const auto entropy = [](const std::vector<double>& shares) {
      double sum = 0;
      double weighed = 0;
      for (const double one : shares) {
        if (one < kShareNone) continue;
        sum += one;
        weighed += one * std::log(one);
      }
      return std::log(sum) - weighed / sum;
    };
    std::vector<double> all(bins);
    std::vector<double> here(bins);
    double known = 0;
    for (std::size_t i = 0; i < expected.size();) {
      std::fill(here.begin(), here.end(), 0.0);
      const std::size_t ball = expected[i].ball;
      for (; i < expected.size() && expected[i].ball == ball; ++i) {
        const Expected& one = expected[i];
        const double scale = 1 / one.stddev;
        const auto bin = [&](double value) {
          return static_cast<std::size_t>(std::max(0.0, (value - low) / kBin));
        };
        const std::size_t last = std::min(bins - 1, bin(one.mean + kTailEnd * one.stddev));
        for (std::size_t k = bin(one.mean - kTailEnd * one.stddev); k <= last; ++k) {
          const double off = (low + (static_cast<double>(k) + 0.5) * kBin - one.mean) * scale;
          here[k] += one.share * scale * std::exp(-0.5 * off * off);
        }
      }
      known += entropy(here);
      for (std::size_t k = 0; k < bins; ++k) all[k] += here[k];
    }
    return std::max(0.0, entropy(all) - known / static_cast<double>(balls_.size()));
  }

  const MapLikelihood& likelihood_;
  std::size_t count_;  ///< touched places
  StiffnessField::Whitened whitened_;
  std::array<std::vector<double>, StiffnessField::kGuesses> levels_;  ///< white ones
  ByGuess level_information_{};                                       ///< [-]
  std::vector<Ball> balls_;
};

}  // namespace

double touch_gain(const MapLikelihood& likelihood,
                  const BallField& field,
                  const MapPosterior& posterior,
                  const Place& place) {
  return Forecast{likelihood, field, posterior}.gain(place);
}

std::optional<NextTouch> next_touch(const MapLikelihood& likelihood,
                                    const BallField& field,
                                    const MapPosterior& posterior,
                                    double travel) {
  const Forecast forecast{likelihood, field, posterior};
  Place low = likelihood.places().front().place;
  Place high = low;
  for (const PlaceData& touched : likelihood.places()) {
    low = {std::min(low.x, touched.place.x), std::min(low.y, touched.place.y)};
    high = {std::max(high.x, touched.place.x), std::max(high.y, touched.place.y)};
  }
  const auto steps = [](double from, double to) {
    return static_cast<int>((to - from + 2 * kRound) / kGrid);
  };
  std::optional<NextTouch> best;
  for (int i = 0; i <= steps(low.x, high.x); ++i) {
    for (int k = 0; k <= steps(low.y, high.y); ++k) {
      const Place place{low.x - kRound + i * kGrid, low.y - kRound + k * kGrid};
      if (std::abs(place.x) > travel || std::abs(place.y) > travel) continue;
      const double gain = forecast.gain(place);
      if (!best || gain > best->gain) best = NextTouch{place, gain};
    }
  }
  return best;
}

}  // namespace palp::depth
