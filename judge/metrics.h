#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/core/place.h"
#include "judge/felt_stiffness.h"
#include "judge/first_press.h"

/// Judges a run from the plant's true states: how stiff the tissue felt, how much energy came out
/// of the operator's port, what drifted. Pure functions of the recorded ticks.
namespace palp::judge {

enum class PhaseKind : std::uint8_t { Other, FreeAir, Tap, PressHold, LiftHold, Drag };

/// Where in the script a tick lies.
struct PhaseTag {
  PhaseKind kind{PhaseKind::Other};
  Site site{Site::Other};  ///< what the errors of a site are of; Other: of none
  Place place;             ///< where it begins
  int index{};             ///< of the tap (1, 2, ...) or of the press hold (1: shallow, 2: deep)
  double elapsed{};        ///< [s] since the phase began
  double duration{};       ///< [s]
};

/// True states of one 1 kHz tick. Positions are relative to the true surface at rest.
struct RunTick {
  double at{};  ///< [s], since the start of the run
  PhaseTag phase;
  bool counted{};                ///< the surgeon's site was Engaged or in Hold
  double hand{};                 ///< [m], x_m
  double surface{};              ///< [m], where the surface is now, of its place at rest
  double hand_velocity{};        ///< [m/s]
  double hand_force{};           ///< [N], F_h as applied
  double force_true{};           ///< [N], static law of the tissue at the hand's position
  double contact_force{};        ///< [N], F_c, largest since the last tick
  double tip{};                  ///< [m], x_s
  double tip_velocity{};         ///< [m/s], of the stage
  Place tip_place;               ///< of the stage
  bool told_short{};             ///< the surgeon's site says that the force is incomplete
  double energy_operator{};      ///< [J], E_op: work of the hand on the device since the start
  double energy_operator_min{};  ///< [J], least E_op so far, at plant steps
  double energy_net_min{};       ///< [J], least (E_op - E_tissue) so far
};

struct MetricsConfig {
  double force_cap{8.5};                                             ///< [N], of the haptic device
  double period{1e-3};                                               ///< [s]
  double force_continuous{std::numeric_limits<double>::infinity()};  ///< [N], of its motors
  double own_swing{};  ///< [m], of the same hand at the tissue with its own finger: hand and
                       ///< tip may swing so much
  double stiffest{std::numeric_limits<double>::infinity()};  ///< [N/m], most that may be shown
  double round_trip{};                                       ///< [s], mean, of the path
  double tip_force_limit{3};  ///< [N], above it the patient's gate retreats
  EnergyBound bound;          ///< of the law, and the hand that it is held to
  /// Of the blackout and 2 s after it, in seconds of the recorded ticks; equal: there was none.
  double blackout_from{};  ///< [s]
  double blackout_to{};    ///< [s]
};

inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// One tap as the surgeon felt it.
struct TapMetrics {
  Site site{};
  Place place;
  int index{};
  double began_at{};        ///< [s], as RunTick::at
  double ended_at{};        ///< [s]
  double hand_max{};        ///< [m]
  FeltStiffness stiffness;  ///< F_h on x_m while loading, beside the static law at the same places
};

/// Of the whole run, also while the operator waits or aligns: as long as the surgeon's process
/// lives and its pedal is down. Not metrics_of()'s: whoever made the ticks knows.
struct WholeRunMetrics {
  double force_step{};  ///< [N], worst change of F_h in 10 ms
  // Of pauses of a site's process.
  double force_kick{};         ///< [N], most that the force grew in 10 ms for no motion
  double force_drop{};         ///< [N], the same as it fell
  double force_unexplained{};  ///< [N], of both, less what the hand's way does to a spring
  double energy_given{};       ///< [J], as energy_operator, less what forces gave while the process
                               ///< stood still
};

/// Of any gesture, at both ends.
struct ContactMetrics {
  bool unstable_hand{};  ///< it swings, ran away, or was pushed at the device's limit
  bool unstable_tip{};   ///< it swings
  double hand_swing{};   ///< [m], of a limit cycle; see SwingFinder
  double tip_swing{};    ///< [m], likewise
  double force_max{};    ///< [N], of the tip
  /// [N], most that the same hand would press with a finger; whoever made the ticks knows.
  double force_direct{kUndefined};
  /// [-], felt over true force 2 s and a round trip after the first contact of a site, where the
  /// hand stayed: of the site where it falls farthest below what is permitted.
  double share_2s{kUndefined};
  /// [-], most that it could be by the energy that the hand may be given; see FirstPress.
  double share_permitted{kUndefined};
  /// [-], felt over permitted force there, where not all is permitted; see FirstPress.
  double share_given{kUndefined};
  double guard_excess{};         ///< [N], most beyond the gate's limit of the tip's force
  double guard_excess_time{};    ///< [s], longest on end; see TipGuard
  double energy_contact{};       ///< [J], most that the hand got in one contact; see ContactEnergy
  double energy_air_to_air{};    ///< [J], most that it got from air to air
  double announced{kUndefined};  ///< [-], of incomplete forces; see Announcement
  double told_in_vain{kUndefined};  ///< [-], of the time at rest in the tissue; see there
  // Where a law can know the tissue, see KnownTouch.
  double known_tap_error[2]{kUndefined, kUndefined};  ///< [-]
  double held_error[2]{kUndefined, kUndefined};       ///< [-] >= 0
  // Of a drag over something hard, see DragBump.
  double drag_error{kUndefined};   ///< [-], felt by the hand over touched by the tip, - 1
  double drag_shift{kUndefined};   ///< [s]
  double drag_felt{kUndefined};    ///< [N], most of it
  double drag_direct{kUndefined};  ///< [N], of the same hand's finger; whoever made the ticks knows
};

/// Errors are rendered/true - 1 [-]; NaN: undefined.
struct RunMetrics {
  bool unstable{};
  const char* unstable_reason{""};
  double tap_error[2]{kUndefined, kUndefined};     ///< [-], taps 2-4, sites A and B
  double tap1_error[2]{kUndefined, kUndefined};    ///< [-], of the first visit of a site
  double tap2_error[2]{kUndefined, kUndefined};    ///< [-], likewise
  double ratio_error{kUndefined};                  ///< [-]
  double ratio_true{kUndefined};                   ///< [-], of the slopes B/A
  double contrast{kUndefined};                     ///< [-], (ratio felt - 1)/(ratio true - 1)
  double static_error[2]{kUndefined, kUndefined};  ///< [-], press holds
  double static_ratio_error{kUndefined};           ///< [-]
  /// [s], from the first contact of 0.1 N at a site until the force is right, to 0.02 N or 10 %,
  /// through 50 ms of contact deeper than 1 mm.
  double learning[2]{kUndefined, kUndefined};
  double force_rms{kUndefined};  ///< [N], of felt - true over all taps
  double drag_rms{kUndefined};   ///< [N]
  double drag_peak{kUndefined};  ///< [N]
  double drift{kUndefined};      ///< [m]
  double energy_operator{};      ///< [J], most the operator ever got
  double energy_net{};           ///< [J], most excess delivered to the tissue
  double force_step_10ms{};      ///< [N], worst change of F_h in 10 ms
  /// [N], the same less what the hand's own motion does: the smaller of the changes of F_h and of
  /// felt - true, so that a hand that leaves or enters the tissue makes no step by itself.
  double force_step_event{};
  WholeRunMetrics whole;
  double force_peak{};  ///< [N]
  ContactMetrics contact;
  double phantom_force{kUndefined};    ///< [N], |F_h| in the air in and after a blackout
  double stage_speed_max{kUndefined};  ///< [m/s], in and after a blackout
  std::vector<TapMetrics> taps;
};

[[nodiscard]] RunMetrics metrics_of(const std::vector<RunTick>& ticks, const MetricsConfig& config);

}  // namespace palp::judge
