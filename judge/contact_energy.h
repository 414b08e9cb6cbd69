#pragma once

#include <limits>

namespace palp::judge {

/// What the hand got of energy within a contact, and from air to air. Within a contact a device may
/// give back what it took; from air to air whatever the hand got was made. Thread: any one.
class ContactEnergy {
 public:
  static constexpr double kFelt = 0.05;    ///< [N], felt force: in contact
  static constexpr double kLetGo = 0.005;  ///< [N], below it nothing of a contact is left
  static constexpr double kEnded = 0.02;   ///< [s], so long: the contact is over

  /// One tick at the hand.
  struct Look {
    double at{};     ///< [s]
    double felt{};   ///< [N]
    double truth{};  ///< [N], of the tissue at the hand; NaN: nobody knows
    double work{};   ///< [J], of the hand on the device since the start of the run
  };
  /// In order of time.
  void look(const Look& now) noexcept;
  /// [J], most that the hand's work fell in one contact, below what it was where that began.
  [[nodiscard]] double in_contact() const noexcept { return in_contact_; }
  /// [J], most that it fell between two instants outside contacts.
  [[nodiscard]] double air_to_air() const noexcept { return air_to_air_; }

 private:
  bool touches_{};
  double touched_at_{};                                         ///< [s], last
  double work_before_{};                                        ///< [J], last outside contacts
  double work_most_{-std::numeric_limits<double>::infinity()};  ///< [J], outside contacts
  double in_contact_{};                                         ///< [J]
  double air_to_air_{};                                         ///< [J]
  bool begun_{};
};

}  // namespace palp::judge
