#pragma once

#include <limits>

namespace palp::judge {

/// Which share of the forces that stayed incomplete the surgeon was told of in time. A force is
/// incomplete that is felt below the true one by more than kLeast and kShare for kLasts on end,
/// while the hand rests in the tissue, from a round trip after the first contact there. It is
/// announced if it was told of at any tick up to kLasts after it began. And how much of the time at
/// rest in the tissue something was told though the force was whole. Thread: any one.
class Announcement {
 public:
  static constexpr double kContact = 0.05;  ///< [N], true force: in the tissue
  static constexpr double kLeast = 0.05;    ///< [N]
  static constexpr double kShare = 0.05;    ///< [-], of the true force
  static constexpr double kLasts = 0.5;     ///< [s]
  static constexpr double kRest = 5e-3;     ///< [m/s], of the hand

  explicit Announcement(double round_trip) : round_trip_{round_trip} {}  ///< [s]

  /// One tick at the hand.
  struct Look {
    double at{};        ///< [s]
    double felt{};      ///< [N]
    double truth{};     ///< [N]; NaN: nobody knows
    double velocity{};  ///< [m/s]
    bool told{};        ///< the site says that the force is incomplete
  };
  /// In order of time.
  void look(const Look& now) noexcept;
  /// [-]; NaN: no force was incomplete.
  [[nodiscard]] double share() const noexcept { return announced_ / count_; }
  /// [-]; NaN: the hand never rested in the tissue.
  [[nodiscard]] double in_vain() const noexcept { return in_vain_ / rested_; }

 private:
  /// In the tissue, when news of it can be there.
  [[nodiscard]] bool rests(const Look& now) noexcept;

  double round_trip_;  ///< [s]
  bool touches_{};
  double touched_at_{};  ///< [s], first, of this contact
  bool short_{};
  bool counted_{};       ///< the shortage that lasts
  bool told_{};          ///< of it
  double short_from_{};  ///< [s]
  double announced_{};   ///< [-]
  double count_{};       ///< [-]
  double rested_{};      ///< [ticks]
  double in_vain_{};     ///< [ticks]
};

}  // namespace palp::judge
