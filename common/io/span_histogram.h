#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/core/time.h"

namespace palp::io {

/// Counts spans in log-linear cells: 32 to an octave, so a quantile is at most 3.2 % above the
/// truth, from 0 to the longest Duration. Fixed size. Thread: its owner's.
class SpanHistogram {
 public:
  /// Negative spans count as 0.
  void add(Duration span) noexcept {
    const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(0, span.count()));
    ++cells_[cell_of(value)];
    ++total_;
  }

  [[nodiscard]] std::uint64_t total() const noexcept { return total_; }

  /// The upper edge of the cell below which a share `p` in [0, 1] of the spans lies; 0: none yet.
  [[nodiscard]] Duration quantile(double p) const noexcept {
    const double wanted = std::clamp(p, 0.0, 1.0) * static_cast<double>(total_);
    std::uint64_t seen = 0;
    std::size_t last = 0;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      if (cells_[cell] == 0) {
        continue;
      }
      seen += cells_[cell];
      last = cell;
      if (static_cast<double>(seen) >= wanted) {
        break;
      }
    }
    return total_ == 0 ? Duration{0} : Duration{static_cast<std::int64_t>(upper_edge(last))};
  }

 private:
  static constexpr unsigned kLinearBits = 5;  ///< 2^5 cells to an octave
  static constexpr std::uint64_t kLinear = 1U << kLinearBits;
  static constexpr std::size_t kCells = (64 - kLinearBits) * kLinear;

  /// Values below 64 have a cell each; above, the leading six bits name the cell.
  static constexpr std::size_t cell_of(std::uint64_t value) noexcept {
    const auto width = static_cast<unsigned>(std::bit_width(value));
    const unsigned shift = width > kLinearBits + 1 ? width - kLinearBits - 1 : 0;
    return static_cast<std::size_t>((value >> shift) + shift * kLinear);
  }
  static constexpr std::uint64_t upper_edge(std::size_t cell) noexcept {
    const std::uint64_t shift = cell < 2 * kLinear ? 0 : cell / kLinear - 1;
    return ((cell - shift * kLinear + 1) << shift) - 1;
  }

  std::array<std::uint64_t, kCells> cells_{};
  std::uint64_t total_{};
};

}  // namespace palp::io
