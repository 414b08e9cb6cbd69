#pragma once

#include "common/core/place.h"
#include "common/record/notes.h"

namespace palp::patient {

/// Of a planar stage, as the paper's: 500 mm both ways. Places count from the middle.
struct PlaneMotionConfig {
  double travel_x{0.5};    ///< [m], half of it to either side
  double travel_y{0.5};    ///< [m]
  double speed_max{0.15};  ///< [m/s], of each axis, in the air
  /// [m/s], along the surface, pressed into the tissue; 0: never, as of a stage that cannot drag
  double drag_speed{0.02};
  double acceleration_max{8};  ///< [m/s^2], of each axis
};

/// What becomes of the command of one axis in one step.
struct AxisMotion {
  double command{};   ///< [m]
  double velocity{};  ///< [m/s]
};

/// Bounds of one axis.
struct AxisLimits {
  double speed{};         ///< [m/s]
  double acceleration{};  ///< [m/s^2]
  double step_free{};     ///< [m], a step of the target taken at once
};

/// One step of `span` [s] towards `target` [m] as fast as the limits allow, braking in time.
[[nodiscard]] AxisMotion step_axis(const AxisMotion& from,
                                   double target,
                                   const AxisLimits& limits,
                                   double span) noexcept;

/// Where in its plane the stage is sent: within its travel, no faster than it may, and in contact
/// only at the speed of a drag, or not at all where the stage cannot drag. Thread: rt. A value.
class PlaneMotion {
 public:
  explicit PlaneMotion(const PlaneMotionConfig& config) noexcept : config_{config} {}

  /// The stage stands here.
  void begin(const Place& place) noexcept;
  void hold() noexcept { x_.velocity = y_.velocity = 0; }

  /// One step of `span` [s] towards `asked`.
  /// @returns why it does not go there, of what lasts at every step; None: it does.
  record::NoteCode follow(const Place& asked, bool in_contact, double span) noexcept;

  [[nodiscard]] Place command() const noexcept { return {x_.command, y_.command}; }

 private:
  PlaneMotionConfig config_;
  AxisMotion x_;
  AxisMotion y_;
};

}  // namespace palp::patient
