#pragma once

#include <cstdint>

namespace palp::coupling {

/// What a force sensor says when nothing touches it, and what that means for its rounding: noise is
/// the dither that blurs the steps. Thread: rt. A value.
class SensorNoise {
 public:
  /// A reading [N] of no force.
  void listen(double force) noexcept;
  /// Enough was heard to say anything.
  [[nodiscard]] bool known() const noexcept;
  [[nodiscard]] double mean_square() const noexcept { return square_; }  ///< [N^2], of a reading
  [[nodiscard]] double deviation() const noexcept;                       ///< [N]

  /// A force is about to be felt: bias() is from now on that of this noise. `quantum` [N]: the
  /// sensor's step; 0: none.
  void settle(double quantum) noexcept;
  /// [N], mean error of a reading at `force` [N].
  [[nodiscard]] double bias(double force, double quantum) const noexcept;
  /// [N], so far off may the mean of many readings be without it: too little noise to blur steps.
  [[nodiscard]] double doubt() const noexcept { return doubt_; }

 private:
  double square_{};  ///< [N^2]
  std::uint32_t ticks_{};
  double dither_{};  ///< [N], amplitude of the bias
  double doubt_{};   ///< [N]
};

}  // namespace palp::coupling
