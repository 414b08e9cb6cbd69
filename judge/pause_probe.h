#pragma once

#include <cstddef>
#include <deque>

namespace palp::judge {

/// What pauses of a site's process did to the hand, judged from the plant's own states: a device
/// whose process stands still holds its last force, and whatever that does to a hand no law can
/// undo. Thread: any.
class PauseProbe {
 public:
  struct Look {
    bool held{};          ///< the surgeon's process stands still: the device holds its force
    bool resumed{};       ///< a process of either site stood still at the last look, or lies
    bool guarded{};       ///< the force is the site's own: alive, and the pedal down
    double force{};       ///< [N], on the hand
    double force_true{};  ///< [N], of the tissue, had the hand pressed it
    double work{};        ///< [J], of the hand on the device
    double position{};    ///< [m], of the hand, positive into the tissue
  };

  /// Once a tick.
  void look(const Look& now);

  /// [J], most that the hand ever had from the device, less what a held force had given it and it
  /// had not paid back yet.
  [[nodiscard]] double energy_given() const { return energy_given_; }
  /// [N], in 10 ticks in which the process ran, within 100 after a pause: the smaller of the
  /// changes of the force and of the force less the true one, so that a hand that moved is no kick.
  /// Growth of the force only: what lets go pushes nobody.
  [[nodiscard]] double kick() const { return kick_; }
  /// [N], the same of a force that falls.
  [[nodiscard]] double drop() const { return drop_; }
  /// [N], the larger of both, less what the hand's own motion meanwhile and in the 20 ticks before
  /// does to the stiffest spring and the strongest damper of a law: inwards and faster where the
  /// force grows, outwards and slower where it falls.
  [[nodiscard]] double unexplained() const { return unexplained_; }

 private:
  struct Instant {
    double felt{};      ///< [N]
    double less{};      ///< [N], than the true one
    double position{};  ///< [m]
  };
  void judge();
  /// [N], of such a spring and damper, with that sign.
  [[nodiscard]] double explained(double sign) const;

  static constexpr std::size_t kWindow = 10;
  static constexpr std::size_t kMemory = 30;
  static constexpr std::size_t kAfter = 100;

  double energy_given_{};  ///< [J]
  double excused_{};       ///< [J], given by held forces
  bool held_before_{};
  double kick_{};             ///< [N]
  double drop_{};             ///< [N]
  double unexplained_{};      ///< [N]
  std::deque<Instant> past_;  ///< newest last
  std::size_t judged_for_{};  ///< ticks still to come
};

}  // namespace palp::judge
