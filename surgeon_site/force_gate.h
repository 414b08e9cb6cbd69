#pragma once

#include <limits>

#include "common/core/lapse.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/coupling/force_growth.h"
#include "common/record/notes.h"

namespace palp::surgeon {

struct ForceGateConfig {
  double force_max{8.5};         ///< [N] >= 0, peak the device can give
  double force_continuous{1.4};  ///< [N] > 0, what its motors stand for ever
  double thermal_time{10.0};     ///< [s] > 0, time constant of the motors' heat: an assumption
  double fade_slew{40.0};        ///< [N/s] > 0, as the gate closes: 0.4 N in 10 ms
  coupling::ForceGrowthConfig growth;  ///< while it is open
};

struct ForceRequest {
  double force{};     ///< [N], as the law asks; anything, also NaN
  double way{};       ///< [m], of the hand since the last tick, positive into the tissue
  double velocity{};  ///< [m/s], of the hand
  SiteState state{};
  bool pedal_held{};
  bool cut{};  ///< emergency stop or a faulted device: zero at once
  /// [N] >= 0, most that may push the hand out while the gate closes.
  double fade_max{std::numeric_limits<double>::infinity()};
};

struct ForceAnswer {
  double force{};           ///< [N], finite, |force| <= force_max
  bool acted{};             ///< not what the law asked for
  record::NoteCode note{};  ///< None, NotFinite or ForceGateClamped: as it begins
  double detail{};          ///< [by note]
};

/// The last word before the hand. Limits the force to the device's peak and, by an i^2 t account
/// of the motors' heat, to its continuous force; passes none in Parked, Clutched and Stopped or
/// while the pedal is up, and closes by a fade, no faster than the law can pay for. A force grows
/// no faster than ForceGrowth says, whatever the law asks for and whoever told it so; one that
/// falls is left alone. Thread: rt. A value.
class ForceGate {
 public:
  explicit ForceGate(const ForceGateConfig& config) noexcept;
  ForceAnswer pass(const ForceRequest& asked, const Lapse& lapse) noexcept;

  [[nodiscard]] double force() const noexcept { return force_; }  ///< [N], of the last pass()

 private:
  [[nodiscard]] double limit() const noexcept;
  void heat_up(Duration passed) noexcept;

  ForceGateConfig config_;
  coupling::ForceGrowth growth_;
  double force_{};  ///< [N]
  double heat_{};   ///< [N^2], low pass of force^2, stays below force_continuous^2
  bool clamped_{};
  bool not_finite_{};
};

}  // namespace palp::surgeon
