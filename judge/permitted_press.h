#pragma once

#include <limits>
#include <vector>

namespace palp::judge {

/// The hand that presses, and the most energy that it may have been given at any time.
struct EnergyBound {
  double grip{std::numeric_limits<double>::quiet_NaN()};    ///< [N/m]
  double energy{std::numeric_limits<double>::quiet_NaN()};  ///< [J]
  double damping{};                                         ///< [N s/m], of grip and handle
  double friction{};                                        ///< [N], Coulomb, of the handle
  double friction_speed{2e-3};  ///< [m/s], as friction * tanh(v / friction_speed)
};

/// How much of the true force a bound of the energy given to the hand permits in one contact.
/// Thread: any one.
class PermittedPress {
 public:
  static constexpr double kDepthStep = 0.05e-3;  ///< [m], of what is kept of the tissue
  static constexpr double kAll = 1 - 1e-9;       ///< [-], permitted: the whole force
  static constexpr double kOutLeast = 0.5;       ///< [s], that the hand takes to go out

  explicit PermittedPress(const EnergyBound& bound = {}) : bound_{bound} {}

  /// One tick at the hand.
  struct Look {
    double at{};        ///< [s]
    double felt{};      ///< [N]
    double truth{};     ///< [N]
    double position{};  ///< [m], past the surface
    double work{};      ///< [J], of the hand since the start of the run
  };
  /// A contact begins.
  void begin(const Look& now);
  /// In order of time, in contact.
  void look(const Look& now);

  struct Permitted {
    double force{std::numeric_limits<double>::quiet_NaN()};  ///< [N]
    double share{std::numeric_limits<double>::quiet_NaN()};  ///< [-], of the true force there
  };

  /// Most of the true force that may be felt by a hand that holds as in `held`: it is pushed
  /// out from where it had given most to where it rests, at an even speed and by nothing but the
  /// force, until force and tissue agree or the energy is used up: that of the bound, and what the
  /// hand gave in this contact. That takes (F^2 - F0^2)/2k, F0 being the force where it had given
  /// most, and what friction and damping take on the way. What a force must still hold to let go of
  /// is not reckoned with. NaN without a contact or a bound.
  [[nodiscard]] Permitted permitted(const Look& held) const noexcept;

 private:
  struct Depth {
    double position{};  ///< [m], deeper than ever before
    double truth{};     ///< [N], there
  };
  [[nodiscard]] double truth_kept(double position) const noexcept;  ///< [N], at [m], as it was met
  /// [J], that it takes to push the hand out by `way` [m] in `span` [s] to the force [N].
  [[nodiscard]] double taken(double force, double way, double span) const noexcept;

  EnergyBound bound_;
  Look most_;                  ///< where the hand had given most
  double work_before_{};       ///< [J], when the contact began
  std::vector<Depth> depths_;  ///< in the tissue
};

}  // namespace palp::judge
