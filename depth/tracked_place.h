#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "depth/contact_curve.h"
#include "depth/sensor_steps.h"
#include "depth/stroke.h"
#include "depth/stroke_cutter.h"
#include "depth/surface.h"

namespace palp::depth {

/// What strokes have passed on their way here, and when a place counts as changed.
struct PlaceReading {
  double pole_gain{};      ///< [-], of the transducer's pole, per sample
  double filter_gain{};    ///< [-], of the low pass, per sample
  double force_quantum{};  ///< [N], of the transducer; 0: unknown
  double force_range{};    ///< [N], of the transducer
  double change_force{};   ///< [N], mean misfit from which the tissue is not the same
  SurfaceConfig surface;
};

inline constexpr double kNoiseFloor = 1e-5;  // [N]

/// One place along the surface: strokes there add up to one law of contact, with the surface as a
/// parameter (find_surface). The law is compared with the data behind the same two filters: it is
/// they who see filtered force of an unfiltered motion. Unloading branches only sharpen the surface
/// and show how much the force depends on the rate of indentation.
/// A value. Thread: estimator; allocates.
class TrackedPlace {
 public:
  /// `first_contact`: where the force was first felt [m].
  TrackedPlace(const Place& place, double first_contact, std::uint64_t generation);

  [[nodiscard]] const Place& place() const noexcept { return place_; }
  [[nodiscard]] const std::optional<ContactLaw>& law() const noexcept { return law_; }
  /// Once there is a law.
  [[nodiscard]] TouchedPlace seen(std::size_t index, const PlaceReading& reading) const;

  /// Fits surface and law to this stroke and those before it. `noise` [N], of one sample. Other
  /// tissue than before starts afresh with the next of `generations`.
  /// @returns rms of this stroke beside the law [N]; nullopt: no contact was found.
  [[nodiscard]] std::optional<double> learn_loading(const StrokeCutter& stroke,
                                                    const PlaceReading& reading,
                                                    double first_contact,
                                                    double noise,
                                                    std::uint64_t& generations);
  /// The branch after the reversal is no measurement of h, but it shows the surface once more and
  /// how much the rate of indentation adds to the force.
  void learn_unloading(const StrokeCutter& stroke, const PlaceReading& reading);
  /// The present stroke as far as it has come. One that is not monotone says nothing of h, but its
  /// samples say as much of the tissue as any.
  void keep_touch(const StrokeCutter& stroke, const PlaceReading& reading);

 private:
  /// The present stroke's curve, with what the filters did to it taken back, and how far off the
  /// law was.
  struct Branch {
    ContactCurve curve;
    double noise{};        ///< [N], rms of measured force minus law, one sample
    NoiseInSteps contact;  ///< the same, in contact alone
  };

  [[nodiscard]] Branch branch_curve(const StrokeCutter& stroke,
                                    const PlaceReading& reading,
                                    ContactCurve::Branch branch,
                                    const std::optional<ContactLaw>& law) const;
  [[nodiscard]] Touch touch_of(const StrokeCutter& stroke, double force_range) const;
  void start_afresh(double first_contact, std::uint64_t generation);

  Place place_;
  double first_contact_;  ///< [m]
  ContactCurve curve_;
  std::optional<ContactLaw> law_;
  int strokes_{};
  std::vector<Touch> touches_;  ///< of the last strokes
  std::size_t touched_{};       ///< since the generation began
  std::uint64_t generation_;
  double noise_{};        ///< [N], of one sample, of the last stroke
  NoiseInSteps contact_;  ///< measured force minus law
};

}  // namespace palp::depth
