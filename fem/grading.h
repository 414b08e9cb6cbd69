#pragma once

#include <vector>

/// One-dimensional node distributions. Every result is a smooth function of every length given, so
/// that a force over depth or radius carries no noise of the mesh.
namespace palp::fem {

/// Wanted element sizes along a line of `length`: `first` at its beginning, `last` at its end,
/// growing away from both by `growth` per length, never above `most`. Only their proportions count:
/// the number of elements is given.
struct Grading {
  double length{};   ///< [m]
  double first{};    ///< [m]
  double last{};     ///< [m]
  double growth{};   ///< [-]
  double most{1e9};  ///< [m]
};

/// 2 n + 1 positions from 0 to length: ends and middles of n elements.
[[nodiscard]] std::vector<double> distribute(const Grading& grading, int elements);

/// How many elements the sizes ask for.
[[nodiscard]] double elements_wanted(const Grading& grading);

/// Smooth minimum and maximum of two positive numbers.
[[nodiscard]] double smooth_min(double a, double b) noexcept;
[[nodiscard]] double smooth_max(double a, double b) noexcept;

}  // namespace palp::fem
