#pragma once

#include <array>
#include <cstddef>

namespace palp::judge {

/// Finds a limit cycle in a motion: the largest swing [m] from turn to turn that went on for five
/// periods of 5.5 to 60 Hz. What rings down, as a light hand that hits stiff tissue does, is over
/// before. Turns count from kHysteresis on, so tremor and encoder steps do not. A person's own will
/// is slower (taps: 5 Hz). Holds no tick. Thread: any one.
class SwingFinder {
 public:
  static constexpr double kHysteresis = 0.1e-3;  ///< [m], from turn to turn at least
  static constexpr double kSlowest = 5.5;        ///< [Hz]
  static constexpr double kQuickest = 60;        ///< [Hz]
  static constexpr std::size_t kTurns = 10;      ///< [-], five periods

  /// In order of time [s]; `position` [m].
  void look(double at, double position) noexcept;
  /// What was before is none of what comes: the motion breaks here.
  void restart() noexcept;
  /// [m], of the least of kTurns swings on end; 0: none.
  [[nodiscard]] double largest() const noexcept { return largest_; }

 private:
  void turn() noexcept;

  bool begun_{};
  double direction_{};                   ///< [-], +1, -1: where it goes; 0: unknown
  double extreme_{};                     ///< [m], farthest since the last turn
  double extreme_at_{};                  ///< [s]
  double turned_{};                      ///< [m], at the last turn
  double turned_at_{};                   ///< [s]
  std::array<double, kTurns> swings_{};  ///< [m], of quick ones on end
  std::size_t count_{};                  ///< of them
  double largest_{};                     ///< [m]
};

}  // namespace palp::judge
