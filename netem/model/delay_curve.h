#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/random.h"
#include "netem/model/impairment.h"

namespace palp::netem {

/// The quantile function of a delay law of mode exact: a uniform share or a standard normal number
/// becomes a delay of exactly the asked mean, spread and shape, before it is truncated at 0.
/// The constructor computes; at() allocates nothing. Thread: its owner's, fit for rt.
class DelayCurve {
 public:
  explicit DelayCurve(const DelayLaw& law);

  /// In units of the jitter around the mean, of the share `p` (0 < p < 1) of all that are shorter.
  [[nodiscard]] double at_share(double p) const noexcept;
  /// The same where the standard normal is `z`.
  [[nodiscard]] double at_normal(double z) const noexcept {
    if (shape_ == DelayShape::Normal) return z;
    if (bent_.empty()) return bent(z);
    const double place = std::clamp(z + kZMax, 0.0, kZInside) * (kCells / (2 * kZMax));
    const auto cell = static_cast<std::int32_t>(place);
    const double* left = bent_.data() + cell;
    return left[0] + (place - cell) * (left[1] - left[0]);
  }

  /// Its argument should be a standard normal rather than a share.
  [[nodiscard]] bool by_normal() const noexcept {
    return shape_ == DelayShape::Normal || shape_ == DelayShape::Gamma ||
           shape_ == DelayShape::LogNormal;
  }

  /// The law's own mean and spread; of a histogram those of its counts [ns].
  [[nodiscard]] double mean() const noexcept { return mean_; }
  [[nodiscard]] double jitter() const noexcept { return jitter_; }

  /// The correlation of successive normals that gives the delays, truncation included, the
  /// correlation asked for [1].
  [[nodiscard]] double normal_correlation(double asked) const;

 private:
  static constexpr double kZMax = 8.5;  ///< [-], how far bent_ goes; no draw goes further
  static constexpr double kZInside = 2 * kZMax * (1 - 1e-12);  ///< [-], in the last cell
  static constexpr std::size_t kCells = 1700;

  [[nodiscard]] static double lerp_at(const std::vector<double>& values, double place) noexcept {
    const double inside = std::clamp(place, 0.0, static_cast<double>(values.size() - 1));
    const auto cell = std::min(static_cast<std::size_t>(inside), values.size() - 2);
    const double part = inside - static_cast<double>(cell);
    return values[cell] + part * (values[cell + 1] - values[cell]);
  }
  [[nodiscard]] double bent(double z) const noexcept;
  void make_table(std::vector<double> sorted);
  void make_histogram(const DelayHistogram& histogram);
  void make_gamma();
  void make_bent();

  DelayShape shape_;
  double mean_;                 ///< [ns]
  double jitter_;               ///< [ns]
  double floor_;                ///< [ns]
  double log_spread_{};         ///< [1], of the log-normal
  double log_scale_{};          ///< [1], of the log-normal
  std::vector<double> bent_;    ///< [1], of the smooth laws: by z
  std::vector<double> values_;  ///< [1]: table: by rank; histogram: edges
  std::vector<double> shares_;  ///< [1]: histogram: what lies below each edge
};

}  // namespace palp::netem
