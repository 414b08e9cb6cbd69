#pragma once

#include <array>
#include <cstddef>

#include "judge/announcement.h"
#include "judge/contact_energy.h"
#include "judge/drag_bump.h"
#include "judge/first_press.h"
#include "judge/known_touch.h"
#include "judge/metrics.h"
#include "judge/reversal.h"
#include "judge/swing_finder.h"
#include "judge/tip_guard.h"

namespace palp::judge {

/// What one phase of a script was: a tap, a held press, a hold above.
class PhaseAccount {
 public:
  /// Means over the last 40 % of a press hold.
  struct HoldMeans {
    double position{kUndefined};  ///< [m]
    double felt{kUndefined};      ///< [N]
    double truth{kUndefined};     ///< [N]
  };

  void begin(const RunTick& tick);
  void look(const RunTick& tick);

  [[nodiscard]] const PhaseTag& tag() const noexcept { return tag_; }
  [[nodiscard]] bool holds(const PhaseTag& tag) const noexcept;
  [[nodiscard]] TapMetrics tap() const noexcept;
  [[nodiscard]] HoldMeans hold() const noexcept;
  [[nodiscard]] double held_from() const noexcept {
    return began_at_ + 0.6 * tag_.duration;
  }                                                                     ///< [s]
  [[nodiscard]] double ended_at() const noexcept { return ended_at_; }  ///< [s], so far
  /// Mean distance of tip and hand in the last 20 % [m].
  [[nodiscard]] double drift() const noexcept { return apart_ / apart_count_; }
  /// Of x_m to and fro in the second half [m], less that of a surface that breathes: a soft hand
  /// on stiff tissue is carried along.
  [[nodiscard]] double swing() const noexcept { return hand_.size() - surface_.size(); }
  /// The same of the tip, less what the hand does too: a tip that follows is no loop.
  [[nodiscard]] double tip_swing() const noexcept {
    return tip_.size() - surface_.size() - hand_.size();
  }

 private:
  PhaseTag tag_;
  double began_at_{};  ///< [s]
  double ended_at_{};  ///< [s]
  double hand_max_{};  ///< [m]
  Reversal hand_;
  Reversal tip_;
  Reversal surface_;
  FeltStiffness stiffness_;
  HoldMeans sums_;
  double hold_count_{};   ///< [ticks]
  double apart_{};        ///< [m], sum
  double apart_count_{};  ///< [ticks]
};

/// Judges a run tick by tick; holds no tick. Thread: any one.
class RunJudge {
 public:
  explicit RunJudge(const MetricsConfig& config)
      : config_{config},
        first_press_{FirstPress{config.bound, config.round_trip},
                     FirstPress{config.bound, config.round_trip}},
        known_{KnownTouch{config}, KnownTouch{config}},
        guard_{config.tip_force_limit},
        announcement_{config.round_trip} {}

  /// In order of time.
  void look(const RunTick& tick);
  /// Known only now: of the blackout and what is judged with it, none of which was looked at yet.
  void blackout(double from, double to) noexcept;
  /// Of all so far.
  [[nodiscard]] RunMetrics metrics() const;

 private:
  struct Learning {
    double began_at{kUndefined};  ///< [s]
    double right_for{};           ///< [s]
    double took{kUndefined};      ///< [s]
  };
  /// Of one tick, what a step is judged from.
  struct Forces {
    double at{};     ///< [s]
    double felt{};   ///< [N]
    double truth{};  ///< [N]
  };
  /// What was felt of free air.
  struct Air {
    double square{};  ///< [N^2]
    double count{};   ///< [ticks]
    double peak{};    ///< [N]
  };
  static constexpr std::size_t kStepTicks = 10;

  void look_at_phase(const RunTick& tick);
  void look_at_stability(const RunTick& tick);
  void look_at_forces(const RunTick& tick);
  void look_at_learning(const RunTick& tick, Site site);
  void look_at_blackout(const RunTick& tick);
  void end_phase();
  void sum_up();
  void sum_up_first_presses();
  void sum_up_stability();

  MetricsConfig config_;
  RunMetrics metrics_;  ///< as far as it needs no end
  std::size_t ticks_{};
  PhaseAccount phase_;
  std::array<FeltStiffness, 2> pooled_;  ///< of taps 2 and later
  std::array<std::array<PhaseAccount::HoldMeans, 2>, 2> holds_;
  bool swings_{};      ///< the hand, in a hold
  bool tip_swings_{};  ///< the tip, likewise
  SwingFinder hand_swing_;
  SwingFinder tip_swing_;
  bool ran_away_{};
  double at_cap_{};      ///< [s]
  double tap_square_{};  ///< [N^2]
  double tap_count_{};   ///< [ticks]
  Air air_;
  std::array<Forces, kStepTicks> before_;
  std::array<Learning, 2> learning_;
  std::array<FirstPress, 2> first_press_;
  std::array<KnownTouch, 2> known_;
  DragBump drag_;
  ContactEnergy energy_;
  TipGuard guard_;
  Announcement announcement_;
  double energy_operator_min_{};  ///< [J], of the newest tick
  double energy_net_min_{};       ///< [J]
};

}  // namespace palp::judge
