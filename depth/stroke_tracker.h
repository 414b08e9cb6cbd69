#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/time.h"
#include "common/message/depth.h"
#include "depth/reading_aligner.h"
#include "depth/stroke.h"
#include "depth/stroke_cutter.h"
#include "depth/surface.h"
#include "depth/tracked_place.h"

namespace palp::depth {

struct StrokeTrackerConfig {
  ForceSensorFacts sensor{};      ///< whose forces these are
  double filter_cut_off{20};      ///< [Hz], low pass of the paper (section III)
  double period{1e-3};            ///< [s], of the samples
  double stage_rate{1000};        ///< [Hz], of the tip's readings
  double fit_range{4e-3};         ///< [m], of eq. (2): reproduces the paper's hash values
  double noise_max{0.1};          ///< [N], rms of a sample: five times the transducer's
  std::size_t samples_min{30};    ///< of a stroke, in contact
  double place_size{kSamePlace};  ///< [m], farther along the surface is another place
  double change_force{0.015};     ///< [N], mean misfit from which the tissue is not the same
  Duration gap_max{std::chrono::milliseconds{20}};  ///< a longer one cuts the stream
  StrokeCutterConfig cutter;
  SurfaceConfig surface;

  /// Whether two points along the surface [m] are one place.
  [[nodiscard]] bool same_place(const Place& one, const Place& other) const noexcept;
};

/// Strokes out of contact samples: cuts them, says which are fit to be judged, and learns from each
/// what the place shows: where its surface is, by which law the force grows, and the paper's h.
/// Estimators judge what it says; it knows of none of them.
///
/// The transducer's steps of 50 mN leave a free cubic of one stroke open by 10 % of h, most of it
/// through the surface. So the measured branch is first described by a contact law with the surface
/// as a parameter, strokes at one place together (TrackedPlace), and (2) is fitted to that law at
/// evenly spaced d over the full 0 to 4 mm, as the paper's reference curves were, wherever the
/// stroke ended.
///
/// Knows of no table, no true surface and no true depth. Thread: estimator; allocates.
class StrokeTracker {
 public:
  explicit StrokeTracker(const StrokeTrackerConfig& config);

  /// The one way in for samples; those that are no numbers are ignored.
  /// @returns the stroke when its reversal was seen.
  [[nodiscard]] std::optional<Stroke> take(const ContactSample& sample);

  /// Another patient: what is known of the places goes; strokes are counted on.
  void forget();

  /// The loading branch of the last stroke, from the air on. Valid until the next take().
  [[nodiscard]] std::span<const StrokeSample> loading() const noexcept { return cutter_.loading(); }

 private:
  struct Measured {
    double first_contact{};  ///< [m]
    double force_max{};      ///< [N]
    double position_max{};   ///< [m]
    double noise{};          ///< [N], of one sample
    std::size_t in_contact{};
    bool saturated{};
  };

  [[nodiscard]] std::optional<Stroke> follow(const AlignedSample& aligned);
  [[nodiscard]] StrokeSample filter(const AlignedSample& aligned) noexcept;
  [[nodiscard]] Measured measure() const noexcept;
  [[nodiscard]] std::size_t find_place(const Place& place, double first_contact);
  [[nodiscard]] Stroke describe_stroke();
  [[nodiscard]] DepthReason validity(const Measured& measured) const noexcept;
  [[nodiscard]] double hash_of(const ContactLaw& law) const noexcept;

  StrokeTrackerConfig config_;
  PlaceReading reading_;
  ReadingAligner aligner_;
  StrokeCutter cutter_;
  LowPass co_filter_;  ///< of the tip: the sensor's pole, as the force has it
  LowPass position_filter_;
  LowPass force_filter_;
  std::optional<ContactSample> previous_;
  Place began_;  ///< where the samples that follow each other began
  std::vector<TrackedPlace> places_;
  std::vector<std::uint64_t> used_;      ///< by place: the one not used for longest is replaced
  std::optional<std::size_t> learning_;  ///< place whose unloading branch is still to come
  std::uint64_t uses_{};
  std::uint64_t generations_{};
  std::uint32_t number_{};
};

}  // namespace palp::depth
