#include "study/closed_loop/felt_lag.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/small_solver.h"

namespace palp::study {
namespace {

constexpr std::size_t kStep = 10;  // [ms], to both sides, of a velocity
constexpr double kLength = 1e-3;   // [m], so that the unknowns are of one size
constexpr double kSpeed = 10e-3;   // [m/s], likewise

}  // namespace

std::optional<double> FeltLag::lag() const {
  if (ticks_.size() < 2 * kStep + kTicksMin) return std::nullopt;
  const double deepest = std::ranges::max_element(ticks_, {}, &Tick::position)->position;
  SmallSystem<3> system;
  std::size_t count = 0;
  double most = 0;
  for (std::size_t i = kStep; i + kStep < ticks_.size(); ++i) {
    const double x = ticks_[i].position - deepest;
    if (x < -kReach) continue;
    const double moved = ticks_[i + kStep].position - ticks_[i - kStep].position;
    const double speed = moved / (2e-3 * static_cast<double>(kStep));
    const std::array row{1.0, x / kLength, speed / kSpeed};
    for (std::size_t r = 0; r < row.size(); ++r) {
      for (std::size_t k = 0; k <= r; ++k) system.matrix[r][k] += row[r] * row[k];
      system.right[r] += ticks_[i].force * row[r];
    }
    most = std::max(most, std::abs(ticks_[i].force));
    ++count;
  }
  const SmallSolution<3> found = solve(system);
  if (count < kTicksMin || most < kForce || !found.regular) return std::nullopt;
  if (found.x[1] <= 0) return kLagMax;
  const double stiffness = found.x[1] / kLength;
  const double damping = found.x[2] / kSpeed;
  return std::min(kLagMax, 1e3 * std::abs(damping) / stiffness);
}

}  // namespace palp::study
