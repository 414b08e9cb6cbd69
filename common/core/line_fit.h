#pragma once

#include <cstddef>

namespace palp {

/// Least-squares slope, with intercept, of y on x.
class LineFit {
 public:
  void add(double x, double y) noexcept {
    // Running means: the sums of squares never lose the small differences that matter here.
    ++count_;
    const double dx = x - mean_x_;
    mean_x_ += dx / static_cast<double>(count_);
    mean_y_ += (y - mean_y_) / static_cast<double>(count_);
    xx_ += dx * (x - mean_x_);
    xy_ += dx * (y - mean_y_);
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] double spread() const noexcept { return xx_; }  ///< [x^2], sum about their mean
  /// Meaningless with fewer than two different x.
  [[nodiscard]] double slope() const noexcept { return xy_ / xx_; }

 private:
  std::size_t count_{};
  double mean_x_{};  ///< [x]
  double mean_y_{};  ///< [y]
  double xx_{};      ///< [x^2]
  double xy_{};      ///< [x y]
};

}  // namespace palp
