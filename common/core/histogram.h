#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/core/time.h"

namespace palp {

/// Log-linear counts of spans: each octave of nanoseconds in 128 equal cells, so a quantile is
/// within 0.8 % (exact at the extremes and when all spans are equal). Spans below 0 count as 0,
/// spans beyond 18 minutes as that.
/// Thread: its owner's; record() allocates nothing.
class Histogram {
 public:
  void record(Duration span) noexcept {
    const Duration inside = std::clamp(span, Duration{}, kSpanMax);
    ++cells_[cell_of(static_cast<std::uint64_t>(inside.count()))];
    min_ = count_ == 0 ? inside : std::min(min_, inside);
    max_ = std::max(max_, inside);
    const auto value = static_cast<double>(inside.count());
    const double above = value - mean_;
    mean_ += above / static_cast<double>(count_ + 1);
    squares_ += above * (value - mean_);
    ++count_;
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// All of these are 0 while nothing has been recorded.
  [[nodiscard]] Duration min() const noexcept { return min_; }
  [[nodiscard]] Duration max() const noexcept { return max_; }
  [[nodiscard]] Duration mean() const noexcept;
  [[nodiscard]] Duration deviation() const noexcept;  ///< standard deviation
  /// The least span that at least `share` [1] of all do not exceed, interpolated inside its cell.
  [[nodiscard]] Duration quantile(double share) const noexcept;

 private:
  static constexpr unsigned kCellBits = 7;  ///< 128 cells an octave
  static constexpr std::uint64_t kCells = 1U << kCellBits;
  static constexpr unsigned kTopBits = 40;
  static constexpr Duration kSpanMax{(std::int64_t{1} << kTopBits) - 1};

  static constexpr std::size_t cell_of(std::uint64_t nanoseconds) noexcept {
    if (nanoseconds < kCells) return nanoseconds;
    const auto shift = static_cast<unsigned>(std::bit_width(nanoseconds)) - 1 - kCellBits;
    return (shift + 1) * kCells + ((nanoseconds >> shift) - kCells);
  }

  std::array<std::uint64_t, (kTopBits - kCellBits + 1) * kCells> cells_{};
  std::uint64_t count_{};
  Duration min_{};
  Duration max_{};
  double mean_{};     ///< [ns]
  double squares_{};  ///< [ns^2], sum of those of the distances to the mean (Welford 1962)
};

}  // namespace palp
