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
    const bool far = !sorted_ && line_.size() - first_ + wanted <= most_;
    return far && line_.size() < tidy_at_ ? wanted : counted_room(gone, wanted);
  }
  void enter(TimePoint release);

 private:
  static constexpr std::size_t kTidyAt = 4096;
  [[nodiscard]] std::size_t counted_room(TimePoint gone, std::size_t wanted) noexcept;
  void tidy(TimePoint gone) noexcept;

  std::size_t most_;
  std::vector<TimePoint> line_;  ///< as they came, from first_ on; some may have left
  std::size_t first_{};
  std::size_t tidy_at_{kTidyAt};  ///< so many in the line, and those who left are taken out
  /// Near the limit: the line is a heap, the next to leave in front, and nobody in it has left.
  bool sorted_{};
};

}  // namespace palp::netem
