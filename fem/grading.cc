#include "fem/grading.h"

#include <cmath>
#include <cstddef>

#include "common/core/check.h"

namespace palp::fem {
namespace {

constexpr double kSharpness = 6;  // of the smooth minimum: 12 % off where both are equal

/// Elements between 0 and x: the integral of 1/first(x) + 1/last(x) + 1/most.
double count_to(const Grading& grading, double x) {
  const double growth = grading.growth;
  const double from_first = std::log1p(growth * x / grading.first) / growth;
  const double from_last = std::log((grading.last + growth * grading.length) /
                                    (grading.last + growth * (grading.length - x))) /
                           growth;
  return from_first + from_last + x / grading.most;
}

double density_at(const Grading& grading, double x) {
  return 1 / (grading.first + grading.growth * x) +
         1 / (grading.last + grading.growth * (grading.length - x)) + 1 / grading.most;
}

}  // namespace

double elements_wanted(const Grading& grading) { return count_to(grading, grading.length); }

std::vector<double> distribute(const Grading& grading, int elements) {
  PALP_CHECK(elements > 0 && grading.length > 0, "a line has elements and a length");
  PALP_CHECK(grading.first > 0 && grading.last > 0 && grading.growth > 0, "sizes are positive");
  std::vector<double> at{0};
  const double total = elements_wanted(grading);
  for (int i = 1; i < elements; ++i) {
    const double wanted = total * i / elements;
    double low = at.back();
    double high = grading.length;
    double x = low;
    for (int pass = 0; pass < 60; ++pass) {
      const double off = count_to(grading, x) - wanted;
      (off < 0 ? low : high) = x;
      double next = x - off / density_at(grading, x);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - x) < 1e-15 * grading.length) break;
      x = next;
    }
    at.push_back(0.5 * (at.back() + x));
    at.push_back(x);
  }
  at.push_back(0.5 * (at.back() + grading.length));
  at.push_back(grading.length);
  return at;
}

double smooth_min(double a, double b) noexcept {
  return std::pow(std::pow(a, -kSharpness) + std::pow(b, -kSharpness), -1 / kSharpness);
}

double smooth_max(double a, double b) noexcept {
  return std::pow(std::pow(a, kSharpness) + std::pow(b, kSharpness), 1 / kSharpness);
}

}  // namespace palp::fem
