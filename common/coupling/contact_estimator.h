#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/place.h"
#include "common/core/time.h"
#include "common/coupling/breathing_estimator.h"
#include "common/coupling/contact_onset.h"
#include "common/coupling/held_force.h"
#include "common/coupling/sensor_noise.h"
#include "common/coupling/spline_estimator.h"
#include "common/coupling/surface_drift.h"
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

  /// Once per control period, or where a tick came late, `periods` after the last. `force` [N] as
  /// measured, noise may make it negative.
  void step(double position, double force, std::int64_t periods = 1) noexcept;
  /// Another place along the surface: what was learned there, or if nothing was, at the last one,
  /// becomes what is expected.
  void new_place(const Place& place) noexcept;

  [[nodiscard]] const ModelPayload& model() const noexcept { return told_.held.told(); }

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

  /// @returns the way the tip went in this period, half of it on average, the surface at rest [m].
  [[nodiscard]] double sense(double position, double force) noexcept;
  void follow(double position, double force, std::int64_t periods) noexcept;
  void look(double halfway, double force) noexcept;
  void doubt(double threshold) noexcept;
  void begin_contact() noexcept;
  void place_grid(double centre) noexcept;
  void filter_shapes(double position) noexcept;
  void collect(double force) noexcept;
  void absorb() noexcept;
  void search() noexcept;
  void publish(const Solution& solution) noexcept;
  void begin_again() noexcept;
  void withdraw() noexcept;
  void track(double position) noexcept;
  void watch_surface() noexcept;
  void follow_told(double force, bool touches) noexcept;
  [[nodiscard]] Solution solve(std::size_t candidate, bool relaxes) noexcept;
  [[nodiscard]] double surface_of(std::size_t candidate) const noexcept;
  [[nodiscard]] double equation_noise() const noexcept;
  void relax() noexcept;
  [[nodiscard]] double elastic() const noexcept;
  [[nodiscard]] double predicted() const noexcept;
  void fit_spline(const Solution& told) noexcept;
  double fit_spline_beside(const Solution& solution) noexcept;
  [[nodiscard]] bool explains(double left) const noexcept;

  /// What was learned at a place.
  struct Known {
    Place place;
    std::uint32_t visit{};      ///< the last; 0: none
    double touched{};           ///< [s], in contact
    Terms c{};                  ///< [N]
    double surface{};           ///< [m]
    KnotStiffness stiffness{};  ///< [N/m]
    double spline_share{};      ///< [-]
    double deepest{};           ///< [m], tip in contact

    [[nodiscard]] bool is_at(const Place& other) const noexcept {
      return visit > 0 && distance(place, other) <= kSamePlace;
    }
  };
  static constexpr std::size_t kPlaces = 32;
  struct Places {
    Place here;
    std::array<Known, kPlaces> known{};
    std::uint32_t visits{};
  };
  void remember() noexcept;
  [[nodiscard]] const Known* known_at(const Place& place) const noexcept;
  [[nodiscard]] const Known& last_known() const noexcept;
  [[nodiscard]] Known& slot_for(const Place& place) noexcept;

  /// What is sensed, in a frame that moves with the surface and, `raw`, in one that does not.
  struct Sensed {
    bool started{};
    double position_before{};  ///< [m]
    LowPass tip;               ///< [m], behind the transducer's pole
    double tip_speed{};        ///< [m/s]
    double force_before{};     ///< [N]
    double force_mean{};       ///< [N], over 10 ms
    double tip_mean{};         ///< [m], over 10 ms
    double raw_tip{};          ///< [m], behind the transducer's pole
    double raw_tip_mean{};     ///< [m], as tip_mean
  };
  /// The first contact may prove to be noise.
  struct Doubt {
    std::uint32_t ticks{};  ///< for so long
    double tip{};           ///< [m], where it was
  };
  /// Some ticks make one equation.
  struct Box {
    alignas(64) std::array<Lane, kTerms> terms{};  ///< sum
    double force{};                                ///< [N], sum
    std::uint32_t count{};
    double tip{};  ///< [m], where the last box ended
  };
  /// Of all equations, as far as they are remembered.
  struct Sums {
    double square{};  ///< [N^2], of the force
    double weight{};  ///< [-]
  };
  /// What comes beside the shapes.
  struct Beside {
    std::array<double, kModelTimes.size()> past{};  ///< [N], elastic force, averaged
    /// For each time the elastic force less its past [N], and the elastic force times the tip's
    /// speed [N m/s].
    std::array<double, kTerms - kModelTerms> terms{};
  };
  /// Before the data say anything else.
  struct Expected {
    Terms c{};         ///< [N]
    double surface{};  ///< [m]
    double doubt{1};   ///< [-], of the spread of a tissue of which nothing is known
  };
  /// What was felt at this place.
  struct Here {
    bool contact{};
    double touched{};           ///< [s], in contact
    double deepest{};           ///< [m], tip in contact
    double deepest_in_air{-1};  ///< [m], tip that felt nothing, between contacts
    Terms expected{};           ///< [N], before anything was felt
  };

  /// The model, corrected by what a slow tip meets.
  struct Told {
    HeldForce held;
    SurfaceDrift drift;
    bool breathes{};  ///< a breath is believed

    /// What is found together with a breath says itself where the surface is.
    void breathe(bool believed) noexcept {
      if (believed && !breathes) {
        held.forget();
        drift.forget();
      }
      breathes = believed;
    }
  };

  ContactEstimatorConfig config_;
  double gain_;  ///< [-], of the transducer's pole
  ContactOnset onset_;
  Sensed sensed_;
  SensorNoise noise_;

  // The grid.
  bool placed_{};
  Doubt doubt_;
  double centre_{};  ///< [m]
  std::uint32_t ticks_outside_{};
  alignas(64) std::array<Lane, kModelTerms> shapes_{};  ///< [-], filtered
  Box box_;
  alignas(64) std::array<Lane, kPairs> normal_{};  ///< [-]
  alignas(64) std::array<Lane, kTerms> right_{};   ///< [N]
  Sums sums_;
  Beside beside_;
  SplineEstimator spline_;

  // What is known.
  std::array<Terms, kCandidates> found_{};  ///< the last solution of each
  std::size_t best_{};
  std::uint32_t turn_{};
  Expected expected_;
  ModelPayload model_;
  Told told_;
  BreathingEstimator swing_;
  Here here_;
  Places places_;
};

}  // namespace palp::coupling
