#pragma once

#include "common/core/time.h"
#include "surgeon_site/encoder.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/hand_plant.h"
#include "surgeon_site/haptic_device.h"
#include "surgeon_site/scripted_operator.h"

namespace palp::surgeon {

struct SimulatedHandConfig {
  HandPlantConfig plant;
  OperatorConfig person;
  double tremor{0.03e-3};         ///< [m], amplitude, added to the intent
  double tremor_frequency{9.3};   ///< [Hz]
  double encoder_step{0.03e-3};   ///< [m] > 0
  double velocity_cut_off{60.0};  ///< [Hz], low pass on the encoder's rate
  double force_max{8.5};          ///< [N], what the device can give at most
  double force_continuous{1.4};   ///< [N]
};

/// What such a device says of itself.
[[nodiscard]] HandFacts facts_of(const SimulatedHandConfig& config) noexcept;

/// What is true in the simulation and what no device could tell.
struct HandTruth {
  double position{};  ///< [m]
  double velocity{};  ///< [m/s]
  double force{};     ///< [N], as the device applies it now, + pushes out
  double work{};      ///< [J], done by the hand on the device since the start
  double intent{};    ///< [m], without tremor
  Duration script_time{};
  bool performing{};  ///< script time runs
};

/// A hand with a scripted will at a simulated haptic device. Lives up to `now` whenever it is
/// read; the force of the last apply() is held in between. Thread: rt.
class SimulatedHand final : public HapticDevice {
 public:
  SimulatedHand(const SimulatedHandConfig& config, GestureScript script);

  /// The first call only sets the time line. After more than 100 ms without a call the hand lives
  /// 100 ms: the rest of so long a pause is lost to it.
  HandState read(TimePoint now) noexcept override;
  void apply(double force) noexcept override;
  /// Held, it stays at its place whatever the person means; let go, it is where the person is.
  void hold_in_plane(bool held) noexcept override { held_in_plane_ = held; }
  void show(const OperatorView& view) noexcept override { person_.see(view); }
  [[nodiscard]] ScriptProgress progress() const noexcept override { return person_.progress(); }
  [[nodiscard]] HandFacts hand_facts() const noexcept override { return facts_of(config_); }

  [[nodiscard]] HandTruth truth() const noexcept;
  [[nodiscard]] bool finished() const noexcept { return person_.progress().finished; }
  [[nodiscard]] const GestureScript& script() const noexcept { return person_.script(); }

 private:
  [[nodiscard]] Pull pull() const noexcept;
  void live(Duration span) noexcept;

  SimulatedHandConfig config_;
  ScriptedOperator person_;
  HandPlant plant_;
  Encoder encoder_;
  Pull pull_;
  HandState state_;
  Duration age_{};  ///< time lived
  double force_{};  ///< [N]
  bool started_{};
  bool held_in_plane_{};
};

}  // namespace palp::surgeon
