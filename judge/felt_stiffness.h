#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "common/core/line_fit.h"

namespace palp::judge {

/// How stiff the tissue felt on the way in, beside how stiff it is: least-squares slopes of force
/// over the hand's position, with intercept. Below the window contact is still being found, above
/// it the hand turns back. A value.
class FeltStiffness {
 public:
  static constexpr double kFrom = 1.2e-3;  ///< [m], past the surface
  static constexpr double kTo = 3.6e-3;    ///< [m]
  static constexpr std::size_t kTicksMin = 21;

  [[nodiscard]] static bool takes(double indentation, double velocity) noexcept {
    return velocity > 0 && indentation > kFrom && indentation < kTo;
  }
  /// One tick: the hand `indentation` [m] past the surface at `velocity` [m/s] is given `felt` [N],
  /// and the tissue there has `truth` [N]; nullopt: nobody knows. What lies outside the window or
  /// does not move inwards is left out.
  void add(double indentation,
           double velocity,
           double felt,
           const std::optional<double>& truth) noexcept {
    if (!takes(indentation, velocity)) return;
    felt_.add(indentation, felt);
    if (truth) truth_.add(indentation, *truth);
    deepest_ = std::max(deepest_, indentation);
    if (truth) most_ = std::max(most_, *truth);
  }

  /// [N/m]; nullopt: too few ticks, or all at one position.
  [[nodiscard]] std::optional<double> felt() const noexcept { return slope(felt_); }
  /// [N/m]; nullopt also if the truth is not known at each of the ticks.
  [[nodiscard]] std::optional<double> truth() const noexcept {
    return truth_.count() == felt_.count() ? slope(truth_) : std::nullopt;
  }
  /// [m^2], sum of squares of the indentations about their mean; and their root mean [m].
  [[nodiscard]] double spread() const noexcept { return felt_.spread(); }
  [[nodiscard]] double deviation() const noexcept {
    return std::sqrt(felt_.spread() / static_cast<double>(std::max<std::size_t>(1, felt_.count())));
  }
  [[nodiscard]] double deepest() const noexcept { return deepest_; }  ///< [m], of the ticks taken
  [[nodiscard]] double truth_most() const noexcept { return most_; }  ///< [N], likewise
  /// felt / truth - 1 [-]; nullopt: one of them is, or there is no tissue.
  [[nodiscard]] std::optional<double> error() const noexcept {
    const auto given = felt();
    const auto there = truth();
    if (!given || !there || *there == 0) return std::nullopt;
    return *given / *there - 1;
  }

 private:
  [[nodiscard]] static std::optional<double> slope(const LineFit& line) noexcept {
    if (line.count() < kTicksMin || !std::isfinite(line.slope())) return std::nullopt;
    return line.slope();
  }

  double deepest_{};  ///< [m]
  double most_{};     ///< [N]
  LineFit felt_;
  LineFit truth_;
};

}  // namespace palp::judge
