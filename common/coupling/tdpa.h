#pragma once

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/limits.h"
#include "common/coupling/coupling.h"
#include "common/coupling/port_tank.h"

/// Coupling `tdpa`: position forward, force back, and at both ends an observer of the energy that
/// has come out of the channel against what is known to have gone in, with a controller that
/// dissipates the difference (time-domain passivity, with drift compensation). A baseline. Round
/// trips only tune it.
namespace palp::coupling {

struct TdpaConfig {
  double damping{1.5};          ///< [N s/m], on the way in; deliberate: it feeds energy forward
  double damping_back{2.4};     ///< [N s/m], the same on the way back in the air ...
  double damping_out{10};       ///< [N s/m], ... and in contact
  double velocity_cut_off{60};  ///< [Hz]
  /// [N/m], of the spring through which the hand is given the tip's force; > tissue's. With the
  /// damping above half of stiffness times period, holding the force for a period costs nothing.
  double spring{650};
  double reserve{0.04e-3};     ///< [J], kept here of what the hand puts in; the rest goes on
  double reserve_far{0.6e-3};  ///< [J], the same over a long path: what a force that comes late to
                               ///< a hand at rest costs
  double credit{0.6e-3};       ///< [J], kept here of what entered at the other end; more goes back
  double slew{25};             ///< [N/s], of the force
  double spring_local{250};    ///< [N/m], over a long path: between hand and tip while it touches
  double reach{2e-3};          ///< [m], of the hand in a round trip: beyond, news of a force is old
  double creep{6e-3};          ///< [m/s], a hand this slow is at rest
  double calm{0.3};            ///< [-], of a long round trip: the force is smoothed over it
  double drift_rate{20};       ///< [1/s], of what the controller kept the stage from doing
  double fade_out{0.2};        ///< [s], in Hold
  double fade_in{0.5};         ///< [s]
  PortTankConfig tank;
  double period{1e-3};  ///< [s]
};

/// The hand holds one end of a spring; at its other end is what the tip feels. The spring makes the
/// controller exact and smooth: whatever raises its force costs energy that is known to be there,
/// and where there is none left the force falls along the spring, not at once. At every tick:
/// reserve + stored = work of the hand + energy out - energy in, energy out <= energy known to have
/// entered at the other end, reserve >= 0 up to what holding the force for a tick may cost. What
/// the other end declares beyond what this hand put in is believed up to the tank of the port.
///
/// Over a long path the force comes late. To a hand at rest it is given all the same, out of work
/// that the hand has done before; a hand that has moved on is not pushed after it, which would only
/// drain the channel. There the tip's force is followed on to where the hand is by a spring of this
/// site's own: a hand on tissue as stiff as itself would else swing, for ever.
class TdpaSurgeon {
 public:
  explicit TdpaSurgeon(const TdpaConfig& config) noexcept;
  void begin_epoch(double position) noexcept;
  SurgeonOutput step(const SurgeonInput& in, const Lapse& lapse) noexcept;

  [[nodiscard]] double energy_out() const noexcept { return energy_out_; }        ///< [J]
  [[nodiscard]] double energy_remote() const noexcept { return energy_remote_; }  ///< [J]

 private:
  void hear(std::span<const Incoming> arrived) noexcept;
  [[nodiscard]] double stored() const noexcept;
  void account(double work, double way) noexcept;
  [[nodiscard]] double damping(double speed) const noexcept;
  [[nodiscard]] double wanted_force(double position, double trip) noexcept;
  void approach(double wanted, double trip, double passed) noexcept;
  void share_energy(double trip) noexcept;

  TdpaConfig config_;
  VelocityEstimate velocity_;
  PortTank tank_;
  double tip_force_{};      ///< [N], newest
  double tip_position_{};   ///< [m], newest
  double calm_force_{};     ///< [N], the tip's, smoothed
  double mean_force_{};     ///< [N], the tip's over 5 samples: noise is no touch
  double energy_in_{};      ///< [J], that entered here
  double energy_out_{};     ///< [J], that left here
  double energy_remote_{};  ///< [J], known to have entered there
  double reserve_{};        ///< [J], entered here and not yet sent on
  double pull_{};           ///< [N], of the spring
  double drag_{};           ///< [N], of the damping
  bool heard_{};
  Ramp fade_{1};
};

class TdpaPatient {
 public:
  explicit TdpaPatient(const TdpaConfig& config, const PatientDevices& devices = {}) noexcept;
  void begin_epoch(double position) noexcept;
  PatientOutput step(const PatientInput& in, const Lapse& lapse) noexcept;

  [[nodiscard]] double energy_out() const noexcept { return energy_out_; }  ///< [J]

 private:
  void hear(std::span<const Incoming> arrived) noexcept;
  void account(double work) noexcept;

  TdpaConfig config_;
  double step_max_;  ///< [m], of the target in a tick: what the stage can run
  LowPass tip_;      ///< [m], behind the sensor's pole, as the force is
  bool started_{};
  double force_before_{};   ///< [N]
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
