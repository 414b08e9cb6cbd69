#pragma once

#include <limits>

#include "common/core/lapse.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/record/notes.h"

namespace palp::surgeon {

struct ForceGateConfig {
  double force_max{8.5};         ///< [N] >= 0, peak the device can give
  double force_continuous{1.4};  ///< [N] > 0, what its motors stand for ever
  double thermal_time{10.0};     ///< [s] > 0, time constant of the motors' heat: an assumption
  double fade_slew{40.0};        ///< [N/s] > 0: 0.4 N in 10 ms
  /// Fades are limited this long after a change, and until they have caught up. The first sample
  /// of an engagement comes a round trip later, and no round trip may exceed 2.5 s.
  Duration fade_guard{std::chrono::seconds{3}};
};

struct ForceRequest {
  double force{};  ///< [N], as the law asks; anything, also NaN
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
/// while the pedal is up; and turns every jump that a change of state or pedal would make into a
/// fade, where the force grows or the gate closes: there no faster than the law can pay for. So it
/// does with what a late tick finds. Between changes it leaves the law's force alone. Thread: rt. A
/// value.
class ForceGate {
 public:
  explicit ForceGate(const ForceGateConfig& config) noexcept;
  ForceAnswer pass(const ForceRequest& asked, const Lapse& lapse) noexcept;

  [[nodiscard]] double force() const noexcept { return force_; }  ///< [N], of the last pass()

 private:
  [[nodiscard]] double limit() const noexcept;
  void heat_up(Duration passed) noexcept;

  ForceGateConfig config_;
  double force_{};     ///< [N]
  double heat_{};      ///< [N^2], low pass of force^2, stays below force_continuous^2
  SiteState state_{};  ///< of the last pass()
  bool pedal_held_{};  ///< of the last pass()
  bool fading_{};      ///< the force has not caught up yet
  Duration guard_left_{};
  bool clamped_{};
  bool not_finite_{};
};

}  // namespace palp::surgeon
