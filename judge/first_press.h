#pragma once

#include <limits>

namespace palp::judge {

/// How much of the true force a first press gives back once it has settled. It begins with the
/// first force at a place and counts where the hand stays in the tissue until kSettled + kWindow.
/// Holds no tick. Thread: any one.
class FirstPress {
 public:
  static constexpr double kContact = 0.05;  ///< [N], true force: in the tissue
  static constexpr double kSettled = 2.5;   ///< [s], after the first contact: 2 s and half a second
                                            ///< for the longest round trip that is asked for
  static constexpr double kWindow = 0.2;    ///< [s], over which forces are averaged

  /// In order of time: `at` [s], forces at the hand [N].
  void look(double at, double felt, double truth) noexcept;
  /// [-], felt over true; NaN: it was let go of before, or there was none.
  [[nodiscard]] double share() const noexcept;

 private:
  bool begun_{};
  bool over_{};
  double began_at_{};  ///< [s]
  double felt_{};      ///< [N], summed over the window
  double truth_{};     ///< [N], likewise
  bool settled_{};     ///< the window is full
};

}  // namespace palp::judge
