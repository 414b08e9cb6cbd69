#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::patient {

/// The force [N] that a spring and the tissue behind it agree on: where `answer(force)` is `force`.
/// `answer`: what the tissue pushes with [N], >= 0, where the spring carries that force; the more
/// it carries, the further it has given way, and the less the tissue pushes. `guess` [N] >= 0, the
/// last force: from there it takes 3 to 5 answers, in the air one. To 1 nN.
///
/// Newton's method between bounds. To iterate force = answer(force) does not do: a tissue stiffer
/// than the spring throws that from one side to the other, further each time.
template <typename Answer>
[[nodiscard]] double balanced_force(const Answer& answer, double guess) noexcept {
  constexpr double kClose = 1e-9;  // [N]
  constexpr int kStepsMax = 40;
  double force = guess;
  double low = -1;  // the balance is above, once it has been looked at
  double high = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kStepsMax; ++i) {
    const double answered = answer(force);
    const double excess = answered - force;
    if (std::abs(excess) <= kClose) return answered > 0 ? force : 0;
    (excess > 0 ? low : high) = force;
    const double nudge = 1e-6 * std::max(force, 1e-3);
    // An answer that rises, of a tissue that bursts, takes no step the wrong way.
    const double fall = std::max(0.0, (answered - answer(force + nudge)) / nudge);
    const double next = std::max(0.0, force + excess / (1 + fall));
    force = low < next && next < high ? next : (low + high) / 2;
  }
  return force;
}

}  // namespace palp::patient
