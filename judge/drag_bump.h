#pragma once

#include <limits>
#include <vector>

namespace palp::judge {

/// The bump that a drag over something hard makes: the largest force at the hand beside that of the
/// tip, and how much later it was half-way there. Of the first drag of a run, from its begin until
/// the tip lets go or another phase has lasted for kAfter. Thread: any one.
class DragBump {
 public:
  static constexpr double kContact = 0.05;    ///< [N], of the tip
  static constexpr double kAfter = 1.5;       ///< [s], longer than what the path delays
  static constexpr double kBumpLeast = 0.05;  ///< [N], of the tip: less is no bump
  static constexpr double kForceStep = 2e-3;  ///< [N], of what is kept of a force

  /// In order of time: `at` [s], forces [N].
  void look(double at, bool dragging, double felt, double touched);

  /// [-], largest force felt over the largest touched, - 1; NaN: no drag, or no bump.
  [[nodiscard]] double error() const noexcept;
  [[nodiscard]] double felt() const noexcept;  ///< [N], the largest; NaN likewise
  /// [s], from half of the touched bump to half of the felt one; NaN likewise.
  [[nodiscard]] double shift() const noexcept;

 private:
  struct Force {
    double at{};     ///< [s]
    double force{};  ///< [N], higher than ever before in this drag
  };
  using Rise = std::vector<Force>;
  static void add(Rise& rise, const Force& now);
  [[nodiscard]] bool bumped() const noexcept;
  [[nodiscard]] static double half_way(const Rise& rise) noexcept;

  bool begun_{};
  bool over_{};
  double dragged_at_{};  ///< [s], last
  Rise felt_;
  Rise touched_;
};

}  // namespace palp::judge
