#pragma once

#include "common/core/filters.h"
#include "common/core/limits.h"
#include "common/coupling/coupling.h"

/// Coupling `tdpa`: position forward, force back, and at both ends an observer of the energy that
/// has come out of the channel against what is known to have gone in, with a controller that
/// dissipates the difference (time-domain passivity, with drift compensation). A baseline.
namespace palp::coupling {

struct TdpaConfig {
  double damping{1.5};           ///< [N s/m], deliberate: it feeds energy forward
  double damping_max{20};        ///< [N s/m], of the controller
  double velocity_cut_off{60};   ///< [Hz]
  double direction_speed{0.03};  ///< [m/s], outwards: here the limit on what comes back is in full
  double energy_soft{0.1e-3};    ///< [J], below it what comes back fades, so that it never snaps
  double slew{25};               ///< [N/s], of the force
  double drift_rate{20};         ///< [1/s], of what the controller kept the stage from doing
  double speed_max{0.15};        ///< [m/s], of the target
  double sensor_cut_off{20};     ///< [Hz], the transducer's pole: the tip is given the same
  double fade_out{0.2};          ///< [s], in Hold
  double fade_in{0.5};           ///< [s]
  double period{1e-3};           ///< [s]
};

class TdpaSurgeon {
 public:
  explicit TdpaSurgeon(const TdpaConfig& config) noexcept;
  void begin_epoch(double position) noexcept;
  SurgeonOutput step(const SurgeonInput& in, Duration dt) noexcept;

  [[nodiscard]] double energy_out() const noexcept { return energy_out_; }  ///< [J]

 private:
  void hear(std::span<const Incoming> arrived) noexcept;
  void account(double work) noexcept;
  [[nodiscard]] double passive_force(double speed) const noexcept;

  TdpaConfig config_;
  VelocityEstimate velocity_;
  double position_before_{};  ///< [m]
  double tip_force_{};        ///< [N], newest
  double energy_in_{};        ///< [J], that entered here
  double energy_out_{};       ///< [J], that left here
  double energy_remote_{};    ///< [J], known to have entered there
  double force_{};            ///< [N], of the last tick
  bool heard_{};
  Ramp fade_{1};
};

class TdpaPatient {
 public:
  explicit TdpaPatient(const TdpaConfig& config) noexcept;
  void begin_epoch(double position) noexcept;
  PatientOutput step(const PatientInput& in, Duration dt) noexcept;

  [[nodiscard]] double energy_out() const noexcept { return energy_out_; }  ///< [J]

 private:
  void hear(std::span<const Incoming> arrived) noexcept;
  void account(double work) noexcept;

  TdpaConfig config_;
  LowPass tip_;          ///< [m]
  double tip_before_{};  ///< [m]
  bool started_{};
  double hand_{};           ///< [m], newest
  double hand_taken_{};     ///< [m], the part of it the target has been given
  double target_{};         ///< [m]
  double energy_in_{};      ///< [J]
  double energy_out_{};     ///< [J]
  double energy_remote_{};  ///< [J]
};

static_assert(HalfOfLaw<TdpaSurgeon, SurgeonInput, SurgeonOutput>);
static_assert(HalfOfLaw<TdpaPatient, PatientInput, PatientOutput>);

}  // namespace palp::coupling
