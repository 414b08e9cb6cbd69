#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "judge/felt_stiffness.h"
#include "judge/motion.h"
#include "judge/tissue_table.h"

/// The surgeon's side of a stroke: the hand goes into the tissue and out again.
namespace palp::judge {

/// A stroke goes deeper than this past the surface [m]; it is over at half of it.
inline constexpr double kStrokeDepthMin = 1.5e-3;

struct Excursion {
  Place place;               ///< of the deepest tick
  double indentation_max{};  ///< [m], at it
  TimePoint contact_at{};    ///< first tick past the surface
  TimePoint began_at{};      ///< first tick past half of kStrokeDepthMin
  TimePoint deepest_at{};
  TimePoint ended_at{};
  FeltStiffness stiffness;  ///< of its loading: up to the deepest tick
};

/// Finds excursions deeper than kStrokeDepthMin past `surface` [m] in a hand's motion, tick by
/// tick; holds of the motion what one loading needs. Thread: any one.
class ExcursionFinder {
 public:
  /// `tissue`: true at the same positions; nullptr: unknown. Outlives the finder.
  ExcursionFinder(double surface, const TissueTable* tissue) : surface_{surface}, tissue_{tissue} {}

  /// The excursion that ended before this tick.
  std::optional<Excursion> look(const Motion& tick);
  /// One that the motion's end ends.
  std::optional<Excursion> finish();

 private:
  struct Loading {
    double indentation{};  ///< [m]
    double velocity{};     ///< [m/s]
    double force{};        ///< [N]
  };
  /// More ticks inwards through the window than any stroke has: what is longer is not judged.
  static constexpr std::size_t kLoadingMax = 1U << 18U;

  double surface_;  ///< [m]
  const TissueTable* tissue_;
  bool inside_{};
  std::optional<TimePoint> contact_at_;  ///< of what is now past the surface
  TimePoint stroke_contact_at_{};        ///< of the stroke
  Motion first_;
  Motion last_;
  Motion deepest_;
  std::vector<Loading> loading_;  ///< the ticks that a stiffness may be made of
  std::size_t loading_size_{};    ///< of them, up to the deepest tick
};

}  // namespace palp::judge
