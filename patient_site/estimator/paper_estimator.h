#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/time.h"
#include "common/message/depth.h"
#include "patient_site/estimator/contact_curve.h"
#include "patient_site/estimator/stroke_cutter.h"
#include "patient_site/estimator/surface.h"
#include "patient_site/estimator/touch.h"

namespace palp::estimator {

struct PaperEstimatorConfig {
  ForceSensorFacts sensor{};       ///< what the force comes from
  double filter_cut_off{20};       ///< [Hz], low pass of the paper (section III)
  double period{1e-3};             ///< [s], of the samples
  double indentation_min{2.5e-3};  ///< [m], a shorter stroke says nothing on eq. (2) over 4 mm
  double fit_range{4e-3};          ///< [m], of eq. (2): reproduces the paper's hash values
  double noise_max{0.1};           ///< [N], rms of a sample: five times the transducer's
  std::size_t samples_min{30};     ///< of a stroke, in contact
  double place_size{1e-3};         ///< [m], of lateral: farther is another place
  double change_force{0.015};      ///< [N], mean misfit from which the tissue is not the same
  Duration gap_max{std::chrono::milliseconds{20}};  ///< a longer one cuts the stream
  StrokeCutterConfig cutter;
  SurfaceConfig surface;
};

/// The paper's estimator: loading branch of a stroke, 20 Hz low pass on force and position, cubic
/// (2) over 0 to 4 mm of indentation, h, depth by (3) with the paper's coefficients.
///
/// The transducer's steps of 50 mN leave a free cubic of one stroke open by 10 % of h, most of it
/// through the surface. So the measured branch is first described by a contact law with the surface
/// as a parameter (find_surface), strokes at one place together, and (2) is fitted to that law at
/// evenly spaced d over the full 0 to 4 mm, as the paper's reference curves were, wherever the
/// stroke ended. The law is compared with the data behind the same two filters: it is they who see
/// filtered force of an unfiltered motion. Unloading branches only sharpen the surface and show how
/// much the force depends on the rate of indentation.
///
/// Knows of no table, no true surface and no true depth. Thread: estimator; allocates.
class PaperEstimator {
 public:
  explicit PaperEstimator(const PaperEstimatorConfig& config);

  /// @returns the estimate when a stroke's reversal was seen.
  [[nodiscard]] std::optional<DepthEstimate> add(const ContactSample& sample);

  static constexpr std::size_t kTouchesKept = 6;  ///< of a place

  /// What is known of the place of the last estimate, and its last strokes as they were measured.
  /// The last of them ends at its reversal, and grows until it is released.
  struct PlaceData {
    double lateral{};                ///< [m]
    double surface{};                ///< [m], as found
    double rate_factor{};            ///< [s/m], as found
    double noise{};                  ///< [N], of one sample
    std::span<const Touch> touches;  ///< kTouchesKept at most; valid until the next add()
    std::size_t touched{};           ///< so many touches there were, these the last of them
    std::uint64_t generation{};      ///< another one: another tissue
  };
  /// nullopt: the last estimate found no contact.
  [[nodiscard]] std::optional<PlaceData> place() const;

  /// The loading branch that gave an estimate, from the air on. Valid until the next add().
  [[nodiscard]] std::span<const StrokeSample> stroke() const noexcept { return cutter_.loading(); }

 private:
  /// What is known of one place along the surface.
  struct Place {
    double lateral{};        ///< [m]
    double first_contact{};  ///< [m]
    ContactCurve curve;
    std::optional<ContactLaw> law;
    int strokes{};
    std::vector<Touch> touches;  ///< of the last strokes
    std::size_t touched{};       ///< since the generation began
    std::uint64_t generation{};
    double contact_squares{};  ///< [N^2], measured force minus law, in contact
    double contact_count{};    ///< [-]
    std::uint64_t used{};      ///< for replacing the one that was not used for longest
  };

  struct Measured {
    double first_contact{};  ///< [m]
    double force_max{};      ///< [N]
    double position_max{};   ///< [m]
    double noise{};          ///< [N], of one sample
    std::size_t in_contact{};
    bool saturated{};
  };

  /// The present stroke's curve, with what the filters did to it taken back, and how far off the
  /// law was.
  struct Branch {
    ContactCurve curve;
    double noise{};            ///< [N], rms of measured force minus law, one sample
    double contact_squares{};  ///< [N^2], sum of the same, in contact alone
    double contact_count{};    ///< [-]
  };

  [[nodiscard]] StrokeSample filter(const ContactSample& sample) noexcept;
  [[nodiscard]] Measured measure() const noexcept;
  [[nodiscard]] std::size_t find_place(double lateral, double first_contact);
  [[nodiscard]] DepthEstimate estimate_stroke();
  [[nodiscard]] Branch branch_curve(const Place& place,
                                    ContactCurve::Branch branch,
                                    const std::optional<ContactLaw>& law,
                                    double noise) const;
  [[nodiscard]] Touch touch_of(const Place& place) const;
  void keep_touch(Place& place) const;
  [[nodiscard]] bool learn_loading(Place& place, const Measured& measured, DepthEstimate& estimate);
  void learn_unloading();
  void describe(DepthEstimate& estimate,
                const ContactLaw& law,
                const ContactCurve& own,
                double position_max) const;

  PaperEstimatorConfig config_;
  StrokeCutter cutter_;
  LowPass co_filter_;  ///< of the tip: the sensor's pole, which the force has passed
  LowPass position_filter_;
  LowPass force_filter_;
  double filter_gain_;  ///< [-], of the low pass, per sample
  std::optional<ContactSample> previous_;
  std::vector<Place> places_;
  std::optional<std::size_t> learning_;  ///< place whose unloading branch is still to come
  double noise_{};                       ///< [N], of one sample, of the last stroke
  std::uint64_t uses_{};
  std::uint64_t generations_{};
  std::uint32_t number_{};
};

}  // namespace palp::estimator
