#pragma once

#include "judge/permitted_press.h"

namespace palp::judge {

/// How much of the true force a first press gives back once it has settled. It begins with the
/// first force at a place and counts where the hand stays in the tissue until kWindow
/// after it has settled.
/// Beside it, how much of it a bound of the energy given to the hand permits. Thread: any one.
class FirstPress {
 public:
  using Look = PermittedPress::Look;
  static constexpr double kContact = 0.05;  ///< [N], true force: in the tissue
  static constexpr double kSettled = 2;     ///< [s], and a round trip, after the first contact
  static constexpr double kWindow = 0.2;    ///< [s], over which forces are averaged

  /// `round_trip` [s]: mean, of the path.
  explicit FirstPress(const EnergyBound& bound = {}, double round_trip = 0)
      : settled_after_{kSettled + round_trip}, press_{bound} {}

  /// In order of time.
  void look(const Look& now);
  /// [-], felt over true; NaN: it was let go of before, or there was none.
  [[nodiscard]] double share() const noexcept;
  /// [-], most that the same could be; see PermittedPress. NaN as share(), or without a bound.
  [[nodiscard]] double permitted() const noexcept { return most().share; }
  /// [-], felt over the force that the bound permits. NaN as permitted(), and where it permits all.
  [[nodiscard]] double given() const noexcept;

 private:
  [[nodiscard]] PermittedPress::Permitted most() const noexcept;

  double settled_after_;  ///< [s], the first contact
  PermittedPress press_;
  bool begun_{};
  bool over_{};
  double began_at_{};  ///< [s]
  Look held_;          ///< summed over the window
  double looks_{};     ///< [-], of the window
  bool settled_{};     ///< the window is full
};

}  // namespace palp::judge
