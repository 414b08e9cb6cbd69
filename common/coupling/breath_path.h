#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace palp::coupling {

/// Where a surface is that breathes, no breath like the one before: a damped oscillation about a
/// middle that wanders,
///   s' = v,  v' = -w^2 (s - m) - 2 z w v,  m' = -m/T + white noise,
/// as a Kalman filter of s, v and m [mm, mm/s, mm] in the mean, with the share that each of `N`
/// unknowns has in it, the last of them w [rad/s], in first order (de Jong 1991): so the unknowns
/// are found by least squares of what each sight differs from what was foreseen. Steady before the
/// first sight. Noise moves m alone, so that s is smoother than any tap. Thread: any; allocates
/// nothing. A value.
template <std::size_t N>
class BreathPath {
 public:
  using Shares = std::array<double, N>;

  /// What a sight adds to the least squares.
  struct Innovation {
    double left{};      ///< [mm], not foreseen
    double variance{};  ///< [mm^2], of that, as expected
    Shares by{};        ///< [mm per unit of an unknown], by which it grows
  };

  BreathPath() = default;
  /// `rate` [rad/s], w.
  explicit BreathPath(double rate) noexcept : rate_{rate} {
    covariance_[0][0] = kSpread * kSpread;
    covariance_[1][1] = kSpread * kSpread * rate * rate;
    covariance_[2][2] = kWander * kWander;
  }

  /// `span` [s] >= 0 without a sight.
  void pass(double span) noexcept {
    if (!(span > 0)) return;
    const double steps = std::min(std::ceil(span / kStepMost), kStepsMost);
    const Way way{rate_, span / steps};
    const Way quicker{rate_ + kQuicker, span / steps};
    for (int i = 0; i < static_cast<int>(steps); ++i) go(way, quicker);
  }

  /// The surface is seen at `displacement` [mm], with a `variance` [mm^2], and by so much farther
  /// for each unit of an unknown.
  Innovation see(double displacement, double variance, const Shares& by) noexcept {
    Innovation seen{displacement - mean_[0], covariance_[0][0] + variance, {}};
    for (std::size_t j = 0; j < N; ++j) seen.by[j] = by[j] - shares_[0][j];
    std::array<double, 3> gain{};
    for (std::size_t i = 0; i < 3; ++i) gain[i] = covariance_[i][0] / seen.variance;
    const std::array<double, 3> row = covariance_[0];
    for (std::size_t i = 0; i < 3; ++i) {
      mean_[i] += gain[i] * seen.left;
      for (std::size_t j = 0; j < N; ++j) shares_[i][j] += gain[i] * seen.by[j];
      for (std::size_t k = 0; k < 3; ++k) covariance_[i][k] -= gain[i] * row[k];
    }
    return seen;
  }

  /// The unknowns become others, by `change`.
  void change(const Shares& change) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < N; ++j) mean_[i] += shares_[i][j] * change[j];
    }
    rate_ += change[N - 1];
  }

  [[nodiscard]] double displacement() const noexcept { return mean_[0]; }       ///< [mm]
  [[nodiscard]] double variance() const noexcept { return covariance_[0][0]; }  ///< [mm^2], of it
  [[nodiscard]] double velocity() const noexcept { return mean_[1]; }           ///< [mm/s]
  [[nodiscard]] double rate() const noexcept { return rate_; }                  ///< [rad/s]

 private:
  static constexpr double kSpread = 0.65;    ///< [mm], of s at rest in the mean
  static constexpr double kWander = 0.15;    ///< [mm], of m
  static constexpr double kMemory = 1;       ///< [s], T
  static constexpr double kDamping = 0.05;   ///< [-], z
  static constexpr double kStepMost = 0.15;  ///< [s]
  static constexpr double kStepsMost = 40;   ///< [-]
  static constexpr double kQuicker = 1e-4;   ///< [rad/s], for how all this grows with w

  /// The motion in a step in which m stands still.
  struct Way {
    Way(double rate, double span) noexcept {
      const double damped = rate * std::sqrt(1 - kDamping * kDamping);
      const double fall = std::exp(-kDamping * rate * span);
      const double c = fall * std::cos(damped * span);
      const double s = fall * std::sin(damped * span);
      const double share = kDamping / std::sqrt(1 - kDamping * kDamping);
      keep = std::exp(-span / kMemory);
      by = {{{c + share * s, s / damped, 1 - c - share * s},
             {-rate * rate * s / damped, c - share * s, rate * rate * s / damped},
             {0, 0, keep}}};
      noise = kWander * kWander * (1 - keep * keep);
    }
    double keep{};  ///< [-]
    std::array<std::array<double, 3>, 3> by{};
    double noise{};  ///< [mm^2]
  };

  void go(const Way& way, const Way& quicker) noexcept {
    std::array<double, 3> mean{};
    std::array<Shares, 3> shares{};
    std::array<std::array<double, 3>, 3> half{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        mean[i] += way.by[i][k] * mean_[k];
        shares[i][N - 1] += (quicker.by[i][k] - way.by[i][k]) / kQuicker * mean_[k];
        for (std::size_t j = 0; j < N; ++j) shares[i][j] += way.by[i][k] * shares_[k][j];
        for (std::size_t j = 0; j < 3; ++j) half[i][j] += way.by[i][k] * covariance_[k][j];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        covariance_[i][j] = 0;
        for (std::size_t k = 0; k < 3; ++k) covariance_[i][j] += half[i][k] * way.by[j][k];
      }
    }
    covariance_[2][2] += way.noise;
    mean_ = mean;
    shares_ = shares;
  }

  double rate_{1};                ///< [rad/s]
  std::array<double, 3> mean_{};  ///< [mm, mm/s, mm]
  std::array<std::array<double, 3>, 3> covariance_{};
  std::array<Shares, 3> shares_{};
};

}  // namespace palp::coupling
