#pragma once

#include <cstddef>
#include <vector>

#include "common/core/time.h"

namespace palp::netem {

/// How many are on their way, where nothing but their number is wanted: a fraction of the work of
/// keeping them in the order of their releases. Thread: its owner's; it may allocate.
class Occupancy {
 public:
  explicit Occupancy(std::size_t most) : most_{most} {}

  /// Places free for those who come when `gone` is over, at most `wanted`: who is released at
  /// `gone` or before has left.
  [[nodiscard]] std::size_t room(TimePoint gone, std::size_t wanted) noexcept {
    // Far from the limit nobody need be counted.
    if (line_.size() - first_ + wanted <= most_ && line_.size() < kTidyAt) return wanted;
    return counted_room(gone, wanted);
  }
  void enter(TimePoint release) { line_.push_back(release); }

 private:
  static constexpr std::size_t kTidyAt = 4096;
  [[nodiscard]] std::size_t counted_room(TimePoint gone, std::size_t wanted) noexcept;

  std::size_t most_;
  std::vector<TimePoint> line_;  ///< as they came, from first_ on; some may have left
  std::size_t first_{};
};

}  // namespace palp::netem
