#pragma once

#include <span>
#include <vector>

namespace palp::depth {

/// Part of a posterior of the depth: a share spread evenly over a range of the depth's logarithm.
struct DepthMass {
  double log_depth{};  ///< [-], of m, the middle
  double width{};      ///< [-]
  double log_mass{};   ///< [-]
};

/// What many such parts say together. A value. Thread: estimator.
class DepthDistribution {
 public:
  /// Nothing lies outside `low` to `high` [m].
  DepthDistribution(std::span<const DepthMass> masses, double low, double high);

  [[nodiscard]] double log_total() const noexcept { return log_total_; }  ///< [-]
  [[nodiscard]] double mean() const noexcept { return mean_; }            ///< [m]
  [[nodiscard]] double stddev() const noexcept { return stddev_; }        ///< [m]
  /// Share of the depths above (less deep than) the quantile. [-] -> [m]
  [[nodiscard]] double quantile(double share) const noexcept;

  struct Interval {
    double low{};   ///< [m]
    double high{};  ///< [m]
  };
  /// That holds 95 %. What is left out lies above by a fifth: that nothing lies above is what a
  /// hand relies on. Where the likeliest depth is an end of the range, the interval runs to it: the
  /// truth may lie there, or beyond.
  [[nodiscard]] Interval interval() const noexcept;

 private:
  [[nodiscard]] double share_above(double depth) const noexcept;

  double from_{};                  ///< [m], nothing lies outside
  double to_{};                    ///< [m]
  double low_{};                   ///< [-], logarithm, of the first entry
  double step_{};                  ///< [-]
  double log_total_{};             ///< [-]
  double mean_{};                  ///< [m]
  double stddev_{};                ///< [m]
  std::vector<double> cumulated_;  ///< [-]
};

}  // namespace palp::depth
