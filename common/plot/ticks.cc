#include "common/plot/ticks.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>

namespace palp::plot {
namespace {

std::vector<double> decades_times(std::initializer_list<double> factors, double from, double to) {
  std::vector<double> ticks;
  const double slack = 1e-9;
  for (int power = static_cast<int>(std::floor(std::log10(from))); power <= std::log10(to);
       ++power) {
    for (const double factor : factors) {
      const double tick = factor * std::pow(10.0, power);
      if (tick >= from * (1 - slack) && tick <= to * (1 + slack)) ticks.push_back(tick);
    }
  }
  return ticks;
}

}  // namespace

std::vector<double> round_ticks(double from, double to, int count) {
  if (!(to > from)) return {from - 0.5, from + 0.5};
  const double rough = (to - from) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= 0.8 * rough) step = factor * power;
  }
  const double first = std::floor(from / step + 1e-9);
  std::vector<double> ticks{first * step};
  while (ticks.back() < to - 1e-9 * step) {
    ticks.push_back((first + static_cast<double>(ticks.size())) * step);
  }
  return ticks;
}

std::vector<double> decade_ticks(double from, double to) {
  return decades_times({1, 2, 5}, from, to);
}

std::vector<double> power_ticks(double from, double to) { return decades_times({1}, from, to); }

std::string tick_text(double value) {
  std::array<char, 24> digits{};
  std::snprintf(digits.data(), digits.size(), "%.6g", std::abs(value));
  return (value < 0 ? "\u2212" : "") + std::string{digits.data()};
}

}  // namespace palp::plot
