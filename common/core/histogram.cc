#include "common/core/histogram.h"

#include <cmath>

namespace palp {

Duration Histogram::mean() const noexcept { return Duration{std::llround(mean_)}; }

Duration Histogram::deviation() const noexcept {
  if (count_ == 0) return {};
  return Duration{std::llround(std::sqrt(squares_ / static_cast<double>(count_)))};
}

Duration Histogram::quantile(double share) const noexcept {
  if (count_ == 0) return {};
  const double rank = std::clamp(share, 0.0, 1.0) * static_cast<double>(count_);
  std::uint64_t below = 0;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const std::uint64_t here = cells_[cell];
    if (here == 0 || static_cast<double>(below + here) < rank) {
      below += here;
      continue;
    }
    const std::size_t octave = cell / kCells;
    const std::size_t shift = octave == 0 ? 0 : octave - 1;
    const std::uint64_t low = octave == 0 ? cell : (kCells + cell % kCells) << shift;
    const double width = static_cast<double>(std::uint64_t{1} << shift);
    const double inside = (rank - static_cast<double>(below)) / static_cast<double>(here);
    const Duration span{std::llround(static_cast<double>(low) + width * inside)};
    return std::clamp(span, min_, max_);
  }
  return max_;
}

}  // namespace palp
