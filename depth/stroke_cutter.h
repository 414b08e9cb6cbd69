#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/message/depth.h"

namespace palp::depth {

/// A contact sample as the estimator works with it.
struct StrokeSample {
  ContactSample measured;  ///< as it came
  double tip{};            ///< [m], stage position, unfiltered
  double position{};       ///< [m], the same behind the transducer's pole and the 20 Hz filter
  double force{};          ///< [N], behind the transducer's pole and the 20 Hz filter
  bool read{true};         ///< the force is a reading, and does not lie between two
};

struct StrokeCutterConfig {
  double contact_force{0.05};  ///< [N], filtered; from here it is contact, below half of it air
  double reversal{0.3e-3};     ///< [m], back from the deepest point: a hand's tremor is far below
  std::size_t lead{400};       ///< [samples] kept before contact: they show where the surface is
  std::size_t stroke_max{16'384};  ///< [samples]; a longer stroke is thinned, not cut
};

/// Cuts a stream of samples into strokes: from the air before contact to the reversal (the loading
/// branch of the paper), then on to the release. A hold on the way in is still the same stroke.
/// Thread: estimator. Allocates only in the constructor.
class StrokeCutter {
 public:
  enum class Event : std::uint8_t { None, Reversed, Released };

  explicit StrokeCutter(const StrokeCutterConfig& config);

  /// Reversed: loading() is complete. Released: unloading() is too; the next call starts afresh.
  Event add(const StrokeSample& sample);
  /// Forgets everything: there was a gap, or the place changed.
  void reset() noexcept;

  [[nodiscard]] std::span<const StrokeSample> loading() const noexcept;
  /// The loading branch and what came after it.
  [[nodiscard]] std::span<const StrokeSample> samples() const noexcept { return samples_; }
  [[nodiscard]] std::size_t loading_count() const noexcept { return deepest_ + 1; }
  /// The tip went back and pressed on deeper before it let go.
  [[nodiscard]] bool pressed_again() const noexcept { return pressed_again_; }

 private:
  enum class Phase : std::uint8_t { Unknown, Air, Loading, Unloading, Done };

  void keep(const StrokeSample& sample);
  void keep_lead(const StrokeSample& sample);
  Event follow(const StrokeSample& sample);

  StrokeCutterConfig config_;
  Phase phase_{Phase::Unknown};
  std::vector<StrokeSample> samples_;  ///< in the air: the lead
  std::size_t deepest_{};              ///< index of the deepest sample
  std::size_t stride_{1};              ///< one sample in so many is kept
  std::size_t skipped_{};
  bool pressed_again_{};
};

}  // namespace palp::depth
