#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

/// What devices are, as they say it themselves. Nobody else describes a device: laws, gates,
/// estimator and record take its numbers from here. The defaults are those of the simulated ones.
namespace palp {

/// Of a haptic master.
struct HandFacts {
  std::uint32_t axes{3};         ///< 1 to 6; the first is that of the force, then x and y
  double force_peak{8.5};        ///< [N], 0.01 to 1000
  double force_continuous{1.4};  ///< [N], 0.01 to the peak; for i^2 t
  double rate{1000};             ///< [Hz], 1 to 100,000; of new readings and forces
  double lag{};                  ///< [s], 0 to 10; from a command that is taken to its force
};

/// Of a stage. Travel is that along the normal where nothing else is said, speed and acceleration
/// are those of each axis.
struct StageFacts {
  std::uint32_t axes{3};     ///< 1 to 6; the first is the normal, then x and y
  double travel_min{-0.2};   ///< [m], -10 to travel_max; + into the tissue
  double travel_max{0.2};    ///< [m], up to 10
  double travel_side{0.25};  ///< [m], 0 to 10; along the surface, to both sides
  double speed{0.15};        ///< [m/s], above 0, to 100
  double acceleration{8};    ///< [m/s^2], above 0, to 10,000
  double rate{1000};         ///< [Hz], 1 to 100,000; of new readings and targets
  double lag{14.3e-3};       ///< [s], 0 to 10; of the tip behind a target that moves evenly
  bool drags{true};          ///< may move along the surface while it touches
};

/// Of a force sensor.
struct ForceSensorFacts {
  double pole{20};      ///< [Hz], 0.1 to 100,000; first order, of each reading
  double step{0.05};    ///< [N], 0 to 1000; 0: none
  double range{49};     ///< [N], 0.01 to 100,000; beyond it a reading is saturated
  double noise{0.015};  ///< [N], 0 to 1000; rms of a reading in quiet air
  double rate{1000};    ///< [Hz], 1 to 100,000; of new readings
  double lag{8e-3};     ///< [s], 0 to 10; of a reading behind the force, its pole included
  double yield{};       ///< [m/N], 0 to 0.01; how far it and what holds it yield; 0: rigid
};

/// [s], from a hand's move to the force that answers it, beside that of a device of 1 kHz: a
/// reading waits for its turn, its answer for the next, and stands for a period.
[[nodiscard]] constexpr double answer_delay(const HandFacts& hand) noexcept {
  constexpr double kUsual = 1e-3;
  const double wait = 1 / hand.rate - kUsual;
  return hand.lag + (wait > 0 ? 1.5 * wait : 0);
}

/// [N], no less is felt as contact: two steps of the sensor, and no less than two of the paper's.
[[nodiscard]] constexpr double felt_as_contact(const ForceSensorFacts& sensor) noexcept {
  constexpr double kLeast = 0.1;
  return 2 * sensor.step > kLeast ? 2 * sensor.step : kLeast;
}

/// What the laws know of the patient's devices.
struct PatientDevices {
  StageFacts stage{};
  ForceSensorFacts sensor{};
};

/// The devices of one site; what a site has not is absent.
struct DeviceFacts {
  std::optional<HandFacts> hand{};
  std::optional<StageFacts> stage{};
  std::optional<ForceSensorFacts> sensor{};
};
static_assert(std::is_trivially_copyable_v<DeviceFacts>, "crosses threads by copy");

/// The first number outside its range, as a sentence's end: "the stage's speed of -1 m/s is not
/// above 0 and at most 100 m/s". nullopt: all are sound. Any numbers may be given. Allocates.
[[nodiscard]] std::optional<std::string> flaw_of(const DeviceFacts& facts);

/// One line for people and metadata: "2 axes, 8.5 N, 1.4 N for ever, 1000 Hz". Allocates.
[[nodiscard]] std::string describe(const HandFacts& hand);
[[nodiscard]] std::string describe(const StageFacts& stage);
[[nodiscard]] std::string describe(const ForceSensorFacts& sensor);

}  // namespace palp
