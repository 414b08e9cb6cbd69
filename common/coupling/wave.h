#pragma once

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/limits.h"
#include "common/coupling/coupling.h"
#include "common/coupling/play_out.h"
#include "common/coupling/port_tank.h"
#include "common/coupling/told_force.h"

/// Coupling `wave`: wave variables. Passive over any path, and as soft as a spring of 2b/RTT in
/// series with the tissue: a tool for short paths, and a baseline.
namespace palp::coupling {

struct WaveConfig {
  double impedance{0};             ///< [N s/m], b; 0: from the next and the patient's devices
  double stiffness_expected{370};  ///< [N/m], the stiffest tissue
  /// [-], of the impedance, at the stage: the fifth more is not for it. It makes free air lighter
  /// where the echo it leaves comes back at once.
  double termination{1 / 1.2};
  double velocity_cut_off{60};  ///< [Hz]
  double drift_rate{2};         ///< [1/s], drift is repaired at zero force, costing no energy
  double drift_speed{0.02};     ///< [m/s], at most
  double contact_zero{0.03};    ///< [N], a mean force below it is none
  double fade{1};               ///< [s], in Retract
  PortTankConfig tank;
  double period{1e-3};  ///< [s]
};

/// The impedance asked for, or what keeps stage and sensor with their lag passive on the stiffest
/// tissue: b >= k tau, with a fifth more; 5 to 15 N s/m. The same at both ends.
[[nodiscard]] double wave_impedance(const WaveConfig& config,
                                    const PatientDevices& devices) noexcept;

/// F_h = b v - sqrt(2b) w; sends the integral and the energy of u = (b v + F_h)/sqrt(2b). While a
/// tick was late the device held its force: the waves of that time are those of this force, and
/// what they brought the hand was played.
/// Waves push or pull no harder than the tank of the port allows, whatever the other end declares,
/// and no faster than ToldForce follows.
class WaveSurgeon {
 public:
  explicit WaveSurgeon(const WaveConfig& config, const PatientDevices& devices = {}) noexcept;
  void meet(const PatientDevices& devices) noexcept;
  void begin_epoch(double position) noexcept;
  SurgeonOutput step(const SurgeonInput& in, const Lapse& lapse) noexcept;

  [[nodiscard]] double tank() const noexcept { return tank_.level(); }  ///< [J]

 private:
  [[nodiscard]] HeldWave account(const SurgeonInput& in, double way, const Lapse& lapse) noexcept;

  WaveConfig config_;
  double impedance_;  ///< [N s/m]
  double root_;       ///< [sqrt(N s/m)], sqrt(2b)
  VelocityEstimate velocity_;
  PlayOut play_out_;
  WavePayload sent_;
  Ramp presence_{1};
  ToldForce told_;
  PortTank tank_;
};

/// Moves the stage at v = (sqrt(2b) u - F)/(b + t): terminated by t = b a stage which follows
/// reflects nothing, by less it does. Any t >= 0 is passive at any time.
class WavePatient {
 public:
  explicit WavePatient(const WaveConfig& config, const PatientDevices& devices = {}) noexcept;
  void begin_epoch(double position) noexcept;
  PatientOutput step(const PatientInput& in, const Lapse& lapse) noexcept;

 private:
  [[nodiscard]] double termination(Duration round_trip) const noexcept;

  WaveConfig config_;
  double impedance_;  ///< [N s/m]
  double root_;       ///< [sqrt(N s/m)], sqrt(2b)
  PlayOut play_out_;
  WavePayload sent_;
  double target_{};      ///< [m]
  double hand_{};        ///< [m], newest
  double force_mean_{};  ///< [N], over 10 ms
};

static_assert(HalfOfLaw<WaveSurgeon, SurgeonInput, SurgeonOutput>);
static_assert(HalfOfLaw<WavePatient, PatientInput, PatientOutput>);

}  // namespace palp::coupling
