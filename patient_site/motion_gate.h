#pragma once

#include <limits>
#include <optional>

#include "common/core/device_facts.h"
#include "common/core/lapse.h"
#include "common/core/place.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/record/notes.h"
#include "patient_site/force_ceiling.h"
#include "patient_site/force_foresight.h"
#include "patient_site/plane_motion.h"

namespace palp::patient {

struct MotionGateConfig {
  double travel_min{-50e-3};       ///< [m], travel box
  double travel_max{50e-3};        ///< [m]
  double depth_max{8e-3};          ///< [m], below the learned surface
  double speed_max{0.15};          ///< [m/s], in the air
  double speed_near{0.05};         ///< [m/s], within `near_distance` of a known surface, in it, and
                                   ///< inwards while none is known
  double near_distance{5e-3};      ///< [m]
  double speed_resync{0.03};       ///< [m/s], after a gap or an engagement, until caught up
  double resync_distance{0.5e-3};  ///< [m], caught up
  double acceleration_max{8};      ///< [m/s^2]
  double step_free{50e-6};         ///< [m], a step of the target taken at once: encoder counts, not
                                   ///< motion
  double force_limit{3};           ///< [N], above it the tip retreats whatever is asked, and then
                                   ///< goes no deeper than its force allows
  double force_stop{5};            ///< [N], above it the site stops
  double retreat_speed{0.03};      ///< [m/s], at force_limit; up to three times that above it
  double retract_speed{5e-3};      ///< [m/s], state Retract
  double clearance{2e-3};          ///< [m], of the tip from the surface after a retraction
  double contact_force{0.1};       ///< [N], felt as contact
  double contact_stiffness{1897};  ///< [N/m^1.5], expected of tissue: how deep contact_force is
  PlaneMotionConfig plane;
};

/// What a law asks for and what the site measures at the same tick.
struct MotionRequest {
  SiteState state{};
  double position{};       ///< [m], target asked for
  Place place{};           ///< place asked for
  double tip{};            ///< [m], of the stage
  double contact_force{};  ///< [N]
  Place stands{};          ///< of the stage, in the plane
  /// [N], the law's limit beside the gate's own: to whatever is lower the tip is braked wherever it
  /// follows or holds
  double force_most{std::numeric_limits<double>::infinity()};
};

struct MotionAnswer {
  double position{};  ///< [m], for the stage
  Place place{};
  bool halt{};   ///< command nothing, hold
  bool acted{};  ///< not what was asked for
  record::NoteCode note{};
  double detail{};                   ///< [by note]
  record::NoteCode place_refused{};  ///< why the tip does not go to the place asked for, as long
                                     ///< as it does not
  record::NoteCode place_note{};     ///< the same at the tick it begins
};

/// The last word before the tissue: nothing reaches the stage but through here, and nothing here
/// depends on the network. Travel box, depth below the surface, speed, acceleration; a contact
/// force above its limit is walked away from. Only Engaged follows the law; Retract, and Parked
/// where the tip is not clear, move out; every other state holds the last command. Learns the
/// surface from the first contact at a place; a drag, from there on until the tip is out again,
/// keeps that surface and what hangs on it. Thread: rt. A value.
class MotionGate {
 public:
  explicit MotionGate(const MotionGateConfig& config,
                      const PatientDevices& devices = {},
                      double period = 1e-3) noexcept  ///< [s], of the calls of feel()
      : config_{config},
        ceiling_{{.limit = config.force_limit}},
        foresight_{devices, period},
        plane_{config.plane},
        noise_square_{config.contact_force * config.contact_force / 4} {}

  /// The tip stands here and nothing was commanded yet.
  void begin(double tip, const Place& place) noexcept;
  /// Once a tick, before pass(), with both as their devices gave them. `age` [s] of the force where
  /// it is a new reading, else nullopt.
  void feel(double tip, double contact_force, std::optional<double> age = 0.0) noexcept;
  /// Catch up slowly from here: after a gap, at an engagement.
  void resynchronise() noexcept { resynchronising_ = true; }
  [[nodiscard]] MotionAnswer pass(const MotionRequest& request, const Lapse& lapse) noexcept;

  /// No contact felt, or the tip well outside: the stage may begin to follow, or change its place.
  [[nodiscard]] bool free_to_follow(double tip) const noexcept;
  /// Clearly deeper than anything that was ever commanded.
  [[nodiscard]] bool too_deep(double tip) const noexcept;
  /// Clearly deeper than the surface that was felt at this place.
  [[nodiscard]] bool inside(double tip) const noexcept;
  /// The retraction is over.
  [[nodiscard]] bool retracted(double tip) const noexcept;
  [[nodiscard]] std::optional<double> surface() const noexcept { return surface_; }  ///< [m]
  [[nodiscard]] double command() const noexcept { return command_; }                 ///< [m]
  [[nodiscard]] Place place() const noexcept { return plane_.command(); }
  [[nodiscard]] double felt_force() const noexcept { return felt_; }  ///< [N], smoothed over 10 ms

 private:
  void learn_surface(double tip) noexcept;
  void doubt_surface(double tip, double least) noexcept;
  void follow(double target, double dt) noexcept;
  void move_out(double tip, double target, double speed, double dt) noexcept;
  void hold() noexcept;
  [[nodiscard]] double force_most(const MotionRequest& request) const noexcept;
  [[nodiscard]] double after_braking(double target, const MotionRequest& request) noexcept;
  void brake(const MotionRequest& request, double dt) noexcept;
  [[nodiscard]] double speed_limit(double target) const noexcept;
  [[nodiscard]] double deepest() const noexcept;
  [[nodiscard]] double within_limits(double position) const noexcept;
  [[nodiscard]] double clear_position() const noexcept;
  [[nodiscard]] bool outside(double tip) const noexcept;
  void follow_place(const MotionRequest& request, double dt, MotionAnswer& answer) noexcept;
  void leave_place(double tip) noexcept;
  void note_once(MotionAnswer& answer, record::NoteCode code, double detail) noexcept;

  MotionGateConfig config_;
  ForceCeiling ceiling_;
  ForceForesight foresight_;
  double command_{};   ///< [m]
  double velocity_{};  ///< [m/s], of the command
  PlaneMotion plane_;
  double felt_{};                  ///< [N]
  double noise_square_;            ///< [N^2], of readings in the air; begins on the safe side
  std::optional<double> surface_;  ///< [m]
  Place surface_place_;            ///< where it was felt
  bool surface_of_this_place_{};
  /// A contact that is young: what was known before, if it proves to be none.
  struct Doubt {
    std::optional<double> surface;  ///< [m], known before
    Place place;                    ///< of that
    double tip{};                   ///< [m], when it began
    int ticks{};                    ///< since then
  };
  std::optional<Doubt> doubt_;
  bool braked_{};  ///< and not asked to go out since
  bool resynchronising_{};
  record::NoteCode noted_{};        ///< of the tick before: a lasting condition is noted once
  record::NoteCode place_noted_{};  ///< the same of the place
};

}  // namespace palp::patient
