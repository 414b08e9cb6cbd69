#include "depth/stiffness_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palp::depth {
namespace {

constexpr double kSpreadLeast = 1e-3;  // [-]
// Tissue that varies less than was said, and as said, or twice as much; spreads as parts of that.
constexpr std::array<FieldGuess, StiffnessField::kGuesses> kOffered{{{0.06, 0, 0.2},
                                                                     {0.3, 0, 0.05},
                                                                     {1, 0, 0.14},
                                                                     {1, 5e-3, 0.14},
                                                                     {1, 8e-3, 0.14},
                                                                     {1, 12e-3, 0.14},
                                                                     {1, 20e-3, 0.14},
                                                                     {2, 10e-3, 0.05}}};
static_assert(kOffered[StiffnessField::kIndependent].spread == 1 &&
              kOffered[StiffnessField::kIndependent].length == 0);
constexpr std::size_t kFirst = 2;                                  // whose covariance is full
constexpr std::size_t kLanes = StiffnessField::kGuesses - kFirst;  // such guesses
using Lanes = std::array<double, kLanes>;

/// The logarithm of a product of many small numbers, with few logarithms.
class LogProduct {
 public:
  void multiply(double factor) noexcept {
    product_ *= factor;
    if (++factors_ % kTogether == 0) flush();
  }
  [[nodiscard]] double value() const noexcept { return sum_ + std::log(product_); }

 private:
  static constexpr unsigned kTogether = 16;  // variances of 1e-8 multiply to 1e-128
  void flush() noexcept {
    sum_ += std::log(product_);
    product_ = 1;
  }
  double sum_{};
  double product_{1};
  unsigned factors_{};
};

/// Cholesky by columns, the right sides with it: column k of the root stands where row k of the
/// covariance stood. The lanes go through it side by side, which the compiler makes wide
/// instructions of. @returns the logarithms of the determinants.
Lanes eliminate(std::size_t n,
                std::size_t width,
                std::vector<double>& root,
                std::vector<double>& right) {
  std::array<LogProduct, kLanes> determinants;
  for (std::size_t k = 0; k < n; ++k) {
    double* column = &root[k * n * kLanes];
    double* row = &right[k * width * kLanes];
    Lanes scale{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double pivot = column[k * kLanes + lane];
      determinants[lane].multiply(pivot);
      scale[lane] = 1 / std::sqrt(pivot);
    }
    for (std::size_t i = k; i < n; ++i) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) column[i * kLanes + lane] *= scale[lane];
    }
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) row[i * kLanes + lane] *= scale[lane];
    }
    for (std::size_t j = k + 1; j < n; ++j) {
      Lanes factor{};
      for (std::size_t lane = 0; lane < kLanes; ++lane) factor[lane] = column[j * kLanes + lane];
      double* later = &root[j * n * kLanes];
      double* below = &right[j * width * kLanes];
      for (std::size_t i = j; i < n; ++i) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          later[i * kLanes + lane] -= factor[lane] * column[i * kLanes + lane];
        }
      }
      for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          below[i * kLanes + lane] -= factor[lane] * row[i * kLanes + lane];
        }
      }
    }
  }
  Lanes log_determinants{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    log_determinants[lane] = determinants[lane].value();
  }
  return log_determinants;
}

}  // namespace

double FieldGuess::correlation(const Place& one, const Place& other) const noexcept {
  const double apart = distance(one, other);
  if (length == 0) return apart <= kSamePlace ? 1 : 0;
  const double r = apart / length;
  return std::exp(-0.5 * r * r);
}

StiffnessField::StiffnessField(std::vector<Place> places, double spread)
    : places_{std::move(places)} {
  for (std::size_t i = 0; i < kGuesses; ++i) {
    guesses_[i] = kOffered[i];
    guesses_[i].spread = std::max(kSpreadLeast, spread * kOffered[i].spread);
  }
  for (std::size_t a = 0; a < places_.size(); ++a) {
    for (std::size_t b = 0; b < places_.size(); ++b) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const FieldGuess& one = guesses_[kFirst + lane];
        // Without a length each is its own: "the same place" is no relation that a covariance has.
        const double alike = a == b || one.length > 0 ? one.correlation(places_[a], places_[b]) : 0;
        covariances_.push_back(one.spread * one.spread * alike);
      }
    }
  }
}

auto StiffnessField::whiten(const std::vector<double>& own,
                            std::size_t width,
                            const std::vector<double>& rows) const -> Whitened {
  const std::size_t n = places_.size();
  Whitened out{.step = n * width, .rows = std::vector<double>(kGuesses * n * width)};
  for (std::size_t guess = 0; guess < kFirst; ++guess) {
    const double spread = guesses_[guess].spread;
    LogProduct determinant;
    for (std::size_t i = 0; i < n; ++i) {
      const double variance = spread * spread + own[i];
      determinant.multiply(variance);
      const double scale = 1 / std::sqrt(variance);
      for (std::size_t k = 0; k < width; ++k) {
        out.rows[guess * out.step + i * width + k] = scale * rows[i * width + k];
      }
    }
    out.log_determinant[guess] = determinant.value();
  }
  std::vector<double> root = covariances_;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) root[(i * n + i) * kLanes + lane] += own[i];
  }
  std::vector<double> right(n * width * kLanes);
  for (std::size_t i = 0; i < n * width; ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) right[i * kLanes + lane] = rows[i];
  }
  const Lanes determinants = eliminate(n, width, root, right);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    out.log_determinant[kFirst + lane] = determinants[lane];
    double* to = &out.rows[(kFirst + lane) * out.step];
    for (std::size_t i = 0; i < n * width; ++i) to[i] = right[i * kLanes + lane];
  }
  return out;
}

std::vector<FieldTold> StiffnessField::told(std::size_t index,
                                            const std::vector<double>& own,
                                            const std::vector<double>& shown,
                                            const std::vector<Place>& others) const {
  const FieldGuess& guess = guesses_[index];
  const double all = guess.spread * guess.spread;
  const std::size_t width = others.size() + 1;
  std::vector<double> rows;
  rows.reserve(places_.size() * width);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    for (const Place& other : others) rows.push_back(all * guess.correlation(places_[i], other));
    rows.push_back(shown[i]);
  }
  const Whitened whitened = whiten(own, width, rows);
  const std::span<const double> white = whitened.of(index);
  std::vector<FieldTold> out(others.size(), FieldTold{.mean = 0, .variance = all});
  for (std::size_t at = 0; at < white.size(); at += width) {
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k].mean += white[at + k] * white[at + width - 1];
      out[k].variance -= white[at + k] * white[at + k];
    }
  }
  for (FieldTold& one : out) one.variance = std::max(one.variance, 0.0);
  return out;
}

}  // namespace palp::depth
