#include "depth/cubic_fit.h"

#include <cmath>

#include "common/core/conventions.h"
#include "depth/least_squares.h"

namespace palp::depth {
namespace {

// The powers are formed of d over this length, so that they are all of order one.
constexpr double kScaleMm = 4;

}  // namespace

double Cubic::force(double indentation) const noexcept {
  const double d = indentation / kMillimetre;
  return ((c[0] * d + c[1]) * d + c[2]) * d + c[3];
}

std::optional<Cubic> fit_cubic(std::span<const CurvePoint> points) noexcept {
  LeastSquares<4> squares;
  for (const CurvePoint& point : points) {
    const double t = point.indentation / kMillimetre / kScaleMm;
    squares.add({t * t * t, t * t, t, 1}, point.force);
  }
  const LeastSquares<4>::Solution solution = squares.solve();
  if (!solution.regular) return std::nullopt;
  Cubic cubic;
  cubic.c = {solution.x[0] / (kScaleMm * kScaleMm * kScaleMm),
             solution.x[1] / (kScaleMm * kScaleMm),
             solution.x[2] / kScaleMm,
             solution.x[3]};
  for (const double c : cubic.c) {
    if (!std::isfinite(c)) return std::nullopt;
  }
  return cubic;
}

}  // namespace palp::depth
