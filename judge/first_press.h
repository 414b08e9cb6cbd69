#pragma once

#include <limits>
#include <vector>

namespace palp::judge {

/// The hand that presses, and the most energy that it may have been given at any time.
struct EnergyBound {
  double grip{std::numeric_limits<double>::quiet_NaN()};    ///< [N/m]
  double energy{std::numeric_limits<double>::quiet_NaN()};  ///< [J]
};

/// How much of the true force a first press gives back once it has settled. It begins with the
/// first force at a place and counts where the hand stays in the tissue until kSettled + kWindow.
/// Beside it, how much of it a bound of the energy given to the hand permits. Thread: any one.
class FirstPress {
 public:
  static constexpr double kContact = 0.05;  ///< [N], true force: in the tissue
  static constexpr double kSettled = 2.5;   ///< [s], after the first contact: 2 s and half a second
                                            ///< for the longest round trip that is asked for
  static constexpr double kWindow = 0.2;    ///< [s], over which forces are averaged

  static constexpr double kDepthStep = 0.05e-3;  ///< [m], of what is kept of the tissue

  explicit FirstPress(const EnergyBound& bound = {}) : bound_{bound} {}

  /// One tick at the hand.
  struct Look {
    double at{};        ///< [s]
    double felt{};      ///< [N]
    double truth{};     ///< [N]
    double position{};  ///< [m], past the surface
    double work{};      ///< [J], of the hand since the start of the run
  };
  /// In order of time.
  void look(const Look& now);
  /// [-], felt over true; NaN: it was let go of before, or there was none.
  [[nodiscard]] double share() const noexcept;
  /// [-], most that the same could be: the hand is pushed out from where it had given most, slowly
  /// and by nothing but the force, until force and tissue agree or the energy is used up. That
  /// takes (F^2 - F0^2)/2k, F0 being the force there. What a hand's own damping takes, and what a
  /// force must still hold to let go of, are not reckoned with. NaN as share(), or without a bound.
  [[nodiscard]] double permitted() const noexcept;

 private:
  struct Depth {
    double position{};  ///< [m], deeper than ever before
    double truth{};     ///< [N], there
  };
  [[nodiscard]] double truth_at(double position) const noexcept;

  EnergyBound bound_;
  Look most_;                  ///< where the hand had given most
  std::vector<Depth> depths_;  ///< in the tissue
  bool begun_{};
  bool over_{};
  double began_at_{};  ///< [s]
  double felt_{};      ///< [N], summed over the window
  double truth_{};     ///< [N], likewise
  bool settled_{};     ///< the window is full
};

}  // namespace palp::judge
