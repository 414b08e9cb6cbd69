#pragma once

#include <algorithm>

namespace palp::judge {

/// How far a motion goes to and fro: the smaller of its largest rise and its largest fall [m]. What
/// only creeps one way, as a hand does whose tissue relaxes, has none. Thread: any one. A value.
class Reversal {
 public:
  void look(double position) noexcept {
    if (!begun_) low_ = high_ = position;
    begun_ = true;
    low_ = std::min(low_, position);
    high_ = std::max(high_, position);
    rise_ = std::max(rise_, position - low_);
    fall_ = std::max(fall_, high_ - position);
  }
  [[nodiscard]] double size() const noexcept { return std::min(rise_, fall_); }

 private:
  bool begun_{};
  double low_{};   ///< [m], so far
  double high_{};  ///< [m]
  double rise_{};  ///< [m], from any earlier position
  double fall_{};  ///< [m]
};

}  // namespace palp::judge
