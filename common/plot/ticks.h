#pragma once

#include <string>
#include <vector>

/// Where an axis has its numbers, and how they read.
namespace palp::plot {

/// Round places from at most `from` to at least `to`, about `count` of them. [as the axis]
[[nodiscard]] std::vector<double> round_ticks(double from, double to, int count);
/// 1, 2 and 5 times the powers of ten between two values above 0. [as the axis]
[[nodiscard]] std::vector<double> decade_ticks(double from, double to);
/// Powers of ten between the same. [as the axis]
[[nodiscard]] std::vector<double> power_ticks(double from, double to);
/// As short as it can be, with a true minus sign.
[[nodiscard]] std::string tick_text(double value);

}  // namespace palp::plot
