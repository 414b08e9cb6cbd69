#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace palp::judge {

/// Finds a limit cycle in a motion: the largest swing [m] from turn to turn that went on for five
/// periods of 5.5 to 60 Hz. What rings down, as a light hand that hits stiff tissue does, is over
/// before. Turns count from kHysteresis on, so tremor and encoder steps do not. A person's own will
/// is slower (taps: 5 Hz). A hand that bounces in each of its quick taps turns as often as one that
/// swings by itself; but what swings by itself gets energy on the way, or it would ring down.
/// Holds no tick. Thread: any one.
class SwingFinder {
 public:
  static constexpr double kHysteresis = 0.1e-3;  ///< [m], from turn to turn at least
  static constexpr double kSlowest = 5.5;        ///< [Hz]
  static constexpr double kQuickest = 60;        ///< [Hz]
  static constexpr std::size_t kTurns = 10;      ///< [-], five periods
  static constexpr std::size_t kEven = 4;  ///< [-], a quick tap that bounces once turns so often

  explicit SwingFinder(double slowest = kSlowest) noexcept : slowest_{slowest} {}  ///< [Hz]

  struct Look {
    double at{};        ///< [s]
    double position{};  ///< [m]
    /// [J], what moves got so much since the start. Swings count that it rose over, from the most
    /// at the first kEven turns to the most at the last: by then a spring has given back what it
    /// took. NaN: nobody knows, all count.
    double given{std::numeric_limits<double>::quiet_NaN()};
  };
  /// In order of time.
  void look(const Look& now) noexcept;
  /// What was before is none of what comes: the motion breaks here.
  void restart() noexcept;
  /// [m], of the least of kTurns swings on end; 0: none.
  [[nodiscard]] double largest() const noexcept { return largest_; }

 private:
  struct Swing {
    double size{};   ///< [m]
    double given{};  ///< [J], until it ended
  };
  void turn() noexcept;
  [[nodiscard]] bool fed() const noexcept;

  double slowest_;  ///< [Hz]
  bool begun_{};
  double direction_{};                  ///< [-], +1, -1: where it goes; 0: unknown
  double extreme_{};                    ///< [m], farthest since the last turn
  double extreme_at_{};                 ///< [s]
  double extreme_given_{};              ///< [J]
  double turned_{};                     ///< [m], at the last turn
  double turned_at_{};                  ///< [s]
  std::array<Swing, kTurns> swings_{};  ///< [-], quick ones on end
  std::size_t count_{};                 ///< of them
  double largest_{};                    ///< [m]
};

}  // namespace palp::judge
