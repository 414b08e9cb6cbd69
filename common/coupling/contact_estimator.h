#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/time.h"
#include "common/coupling/breathing_estimator.h"
#include "common/message/port_sample.h"

/// The patient's half of `mmt` at work: finds the contact model behind positions and forces.
namespace palp::coupling {

struct ContactEstimatorConfig {
  double period{1e-3};              ///< [s], of the control loop
  ForceSensorFacts sensor{};        ///< what the force comes from
  double stiffness_expected{1897};  ///< [N/m^1.5], of plain tissue: where learning begins
  double memory{2};                 ///< [s] of motion in or near contact
  double detection_force{0.026};    ///< [N], least mean force that counts as contact
  double surface_spread{0.5e-3};    ///< [m], of the surface from place to place
};

/// Fits c and the surface of a ModelPayload: for each of 64 candidate surfaces the coefficients
/// >= 0 of least squares with a broad prior, then the best surface. The shapes pass the
/// transducer's pole before they meet the force, which has passed it too: a filter on one side
/// only looks like hysteresis. What relaxes and what moves against the tip are found beside the
/// shapes, so that they do not pass for stiffness; the second is not told. What is known before the
/// data is a prior, not a sample: it gives way to the first of them. Thread: rt; constant memory,
/// bounded work. A value.
class ContactEstimator {
 public:
  explicit ContactEstimator(const ContactEstimatorConfig& config) noexcept;

  /// Once per control period. `force` [N] as measured, noise may make it negative.
  void step(double position, double force) noexcept;
  /// Another place along the surface: what was learned becomes what is expected.
  void new_place() noexcept;

  [[nodiscard]] const ModelPayload& model() const noexcept { return model_; }

 private:
  static constexpr std::size_t kCandidates = 64;
  /// The shapes, what relaxes, and damping.
  static constexpr std::size_t kTerms = kModelTerms + kModelTimes.size() + 1;
  static constexpr std::size_t kPairs = kTerms * (kTerms + 1) / 2;
  using Lane = std::array<double, kCandidates>;
  using Terms = std::array<double, kTerms>;

  struct Solution {
    Terms c{};
    double cost{};  ///< [N^2]
  };

  void sense_noise(double force) noexcept;
  void place_grid(double centre) noexcept;
  void filter_shapes(double position) noexcept;
  void collect(double force) noexcept;
  void absorb() noexcept;
  void search() noexcept;
  void publish(const Solution& solution) noexcept;
  void begin_again() noexcept;
  void withdraw() noexcept;
  void watch_surface(double position) noexcept;
  [[nodiscard]] Solution solve(std::size_t candidate) noexcept;
  [[nodiscard]] double surface_of(std::size_t candidate) const noexcept;
  [[nodiscard]] double rounding_bias(double force) const noexcept;
  [[nodiscard]] double equation_noise() const noexcept;
  void relax() noexcept;
  [[nodiscard]] double elastic() const noexcept;
  [[nodiscard]] double predicted() const noexcept;

  ContactEstimatorConfig config_;
  double gain_;  ///< [-], of the transducer's pole

  // What is sensed.
  bool started_{};
  double position_before_{};  ///< [m]
  LowPass tip_;               ///< [m], behind the transducer's pole
  double tip_speed_{};        ///< [m/s]
  double force_mean_{};       ///< [N], over 10 ms
  double tip_mean_{};         ///< [m], over 10 ms
  double noise_square_{};     ///< [N^2], of a reading in the air
  std::uint32_t noise_ticks_{};
  double dither_{};  ///< [-], amplitude of the rounding bias over its largest

  // The grid.
  bool placed_{};
  bool contact_here_{};
  std::uint32_t doubtful_{};  ///< ticks in which the first contact may prove to be noise
  double doubted_{};          ///< [m], the tip where it was
  double centre_{};           ///< [m]
  std::uint32_t ticks_outside_{};
  alignas(64) std::array<Lane, kModelTerms> shapes_{};  ///< [-], filtered
  alignas(64) std::array<Lane, kTerms> box_{};          ///< sum over the box
  alignas(64) std::array<Lane, kPairs> normal_{};       ///< [-]
  alignas(64) std::array<Lane, kTerms> right_{};        ///< [N]
  double square_{};                                     ///< [N^2]
  double box_force_{};                                  ///< [N]
  std::array<double, kModelTimes.size()> past_{};       ///< [N], elastic force, averaged
  /// What comes beside the shapes: for each time the elastic force less its past [N], and the
  /// elastic force times the tip's speed [N m/s].
  std::array<double, kTerms - kModelTerms> beside_{};
  std::uint32_t box_count_{};
  double box_tip_{};  ///< [m], where the last box ended

  // What is known.
  std::array<Terms, kCandidates> found_{};  ///< the last solution of each
  std::size_t best_{};
  std::uint32_t turn_{};
  Terms expected_{};           ///< [N]
  Terms expected_here_{};      ///< [N], before anything was felt at this place
  double surface_expected_{};  ///< [m]
  ModelPayload model_;
  BreathingEstimator swing_;
  double raw_tip_mean_{};      ///< [m], as tip_mean_, in a frame that does not swing
  double raw_tip_{};           ///< [m], behind the transducer's pole
  double deepest_{};           ///< [m], tip in contact at this place
  double deepest_in_air_{-1};  ///< [m], tip that felt nothing, between contacts at this place
};

}  // namespace palp::coupling
