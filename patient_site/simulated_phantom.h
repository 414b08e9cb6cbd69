#pragma once

#include <cstdint>
#include <memory>

#include "patient_site/breath.h"
#include "patient_site/force_sensor.h"
#include "patient_site/phantom.h"
#include "patient_site/stage.h"

namespace palp::patient {

struct SimulatedPhantomConfig {
  double servo_frequency{20};     ///< [Hz], natural frequency of the position servo
  double servo_damping{0.9};      ///< [-], its damping ratio
  double servo_stiffness{0};      ///< [N/m], against the contact force; 0: nothing moves it
  double stage_lag{14.3e-3};      ///< [s], what the stage says of it; a servo may be otherwise
  double acceleration_max{8};     ///< [m/s^2]
  double speed_max{0.15};         ///< [m/s]
  double encoder_step{5e-6};      ///< [m]; 0: exact
  double start_position{-10e-3};  ///< [m]
  Place start_place{kSiteA};
  double plane_speed_max{0.3};    ///< [m/s], of each axis of the plane
  double plane_travel{0.5};       ///< [m], of each, half of it to either side
  bool can_drag{true};            ///< as facts of stages go
  double surface_offset{0};       ///< [m], where the undeformed surface lies
  double breathing_amplitude{0};  ///< [m], of the surface
  double breathing_frequency{0};  ///< [Hz]
  double breathing_variation{0};  ///< [-], from breath to breath; see BreathConfig
  double viscous_factor{0.5};     ///< [s/m]: F_c = f(d) (1 + factor * rate of d)
  double sensor_cut_off{20};      ///< [Hz], first-order pole of the transducer
  double force_noise{0.015};      ///< [N], rms, white, per sample; 0: none
  double force_quantum{0.05};     ///< [N], paper II.A: resolution of the transducer; 0: exact
  double yield{0};                ///< [m/N], of what lies between encoder and tissue; 0: rigid
  double yield_stated{1};         ///< [-], share of it that the sensor says it has; 1: the truth
  std::uint64_t seed{1};          ///< of the force noise and of what varies in breathing
};

/// What such devices say of themselves.
[[nodiscard]] PatientDevices facts_of(const SimulatedPhantomConfig& config) noexcept;

/// How the surface of such a phantom breathes.
[[nodiscard]] Breath breath_of(const SimulatedPhantomConfig& config) noexcept;

/// The plant's own state, for judges: nothing of it may reach a node.
struct PhantomTruth {
  double position{};  ///< [m], where the tip touches the tissue
  double velocity{};  ///< [m/s], of the same
  Place place{};
  double surface{};        ///< [m], where it is now below the tip (slope, breathing)
  double contact_force{};  ///< [N]
  double noisy_force{};    ///< [N], the transducer's last reading before its rounding
  double tissue_energy{};  ///< [J], integral of F_c dx_s since the start
};

/// A stage, the tissue it presses and the transducer at its tip, simulated together. A position
/// servo moves the tip; in the plane it follows its target without lag, at no more than its speed.
/// The contact force is that of the phantom's field at the present place, depth and rate of
/// indentation. Integrates in steps of 0.1 ms from one `now` to the next.
///
/// By default the tissue does not move the tip. A servo of stiffness K [N/m] is pushed back: the
/// force accelerates the mass K/omega^2 that goes with its frequency, at rest it gives way by F/K,
/// and the encoder sees it. It pulls with no more than K acceleration_max/omega^2; a stronger force
/// pushes the tip away. What yields between encoder and tissue has no mass: the tip stands
/// `yield` F behind what the encoder says, in every step exactly.
/// Thread: rt. Owns nothing it was given: the phantom outlives it.
class SimulatedPhantom final : public Stage, public ForceSensor {
 public:
  SimulatedPhantom(const Phantom& phantom, const SimulatedPhantomConfig& config);

  [[nodiscard]] StageFacts stage_facts() const noexcept override { return facts_of(config_).stage; }
  [[nodiscard]] ForceSensorFacts sensor_facts() const noexcept override {
    return facts_of(config_).sensor;
  }
  StageState read(TimePoint now) noexcept override;
  void move_to(const StageTarget& target) noexcept override;
  void halt() noexcept override;
  std::optional<ForceSample> sample(TimePoint now) noexcept override;

  [[nodiscard]] PhantomTruth truth() const noexcept;

 private:
  void advance(TimePoint now) noexcept;
  void integrate_step() noexcept;
  void touch(double surface_rate) noexcept;
  [[nodiscard]] double force_behind_yield(double stood, double surface_rate) const noexcept;

  SimulatedPhantomConfig config_;
  std::unique_ptr<TissueField> field_;
  double servo_pull_;   ///< [1/s^2]
  double servo_drag_;   ///< [1/s]
  double servo_yield_;  ///< [m/N]
  double sensor_gain_;  ///< [-], of the transducer's pole, per step

  bool started_{};
  TimePoint at_{};         ///< how far the plant has been integrated
  std::uint64_t steps_{};  ///< since the start
  StageTarget target_;
  double position_{};      ///< [m], that of the encoder
  double velocity_{};      ///< [m/s], of the same
  double tip_{};           ///< [m], where the tissue is touched
  double tip_velocity_{};  ///< [m/s]
  Place place_;
  double surface_{};        ///< [m]
  double contact_force_{};  ///< [N]
  double noisy_force_{};    ///< [N], the last reading before its rounding
  double sensed_force_{};   ///< [N], behind the transducer's pole
  double tissue_energy_{};  ///< [J]
  RelaxingForce relaxing_;
  Breath breath_;
};

}  // namespace palp::patient
