#pragma once

#include <array>
#include <cstddef>

namespace palp::coupling {

/// A displacement that goes on as a sine: now, a quarter later, and how fast.
struct Swing {
  double now{};         ///< [m]
  double quadrature{};  ///< [m]
  double rate{};        ///< [rad/s]
  /// After `span` [s].
  [[nodiscard]] double after(double span) const noexcept;
};

/// The breathing of a surface, from where contact showed it to be: a sine at the best of a few
/// frequencies, by least squares that forget. Says nothing until the sine explains most of what
/// was seen. Thread: rt; constant memory and work. A value.
class SurfaceSwing {
 public:
  explicit SurfaceSwing(double period) noexcept;  ///< [s], between calls of step()
  void step() noexcept;                           ///< time goes on
  /// The surface was seen at `position` [m], with `weight` [-].
  void see(double position, double weight) noexcept;
  /// Another place, and with it another mean; it breathes with the same breath.
  void new_mean() noexcept;

  [[nodiscard]] Swing swing() const noexcept;
  /// Seen for long enough to say that it does not breathe.
  [[nodiscard]] bool still() const noexcept { return still_; }

 private:
  static constexpr std::size_t kFrequencies = 32;
  struct Sums {
    double cosine{};    ///< weighted sums of the regressors and their products [-]
    double sine{};      ///< [-]
    double cos_cos{};   ///< [-]
    double cos_sin{};   ///< [-]
    double sin_sin{};   ///< [-]
    double seen_cos{};  ///< [m]
    double seen_sin{};  ///< [m]
  };
  struct Wave {
    double cosine{};     ///< [m]
    double sine{};       ///< [m]
    double explained{};  ///< [m^2], of the weighted sum of squares
  };
  [[nodiscard]] double rate_of(double index) const noexcept;
  /// Sums about the means of the places before.
  struct Past {
    double cos_cos{};   ///< [-]
    double cos_sin{};   ///< [-]
    double sin_sin{};   ///< [-]
    double seen_cos{};  ///< [m]
    double seen_sin{};  ///< [m]
  };
  /// What past and present say about the means.
  [[nodiscard]] Past centred(std::size_t index) const noexcept;
  [[nodiscard]] double centred_square() const noexcept;
  [[nodiscard]] Wave solve(std::size_t index) const noexcept;
  void judge() noexcept;

  double period_;                             ///< [s]
  std::array<double, kFrequencies> rates_{};  ///< [rad/s]
  double time_{};                             ///< [s]
  std::array<Sums, kFrequencies> sums_{};
  std::array<Past, kFrequencies> past_{};
  double past_weight_{};   ///< [-]
  double past_square_{};   ///< [m^2]
  double weight_{};        ///< [-]
  double seen_{};          ///< [m]
  double seen_square_{};   ///< [m^2]
  double first_seen_{-1};  ///< [s]
  double judged_{};        ///< [s]
  // What is believed.
  Swing last_;         ///< as judged last, `judged_` ago
  double presence_{};  ///< [-], fades in and out
  bool believed_{};
  bool still_{};
};

}  // namespace palp::coupling
