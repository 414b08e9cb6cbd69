#pragma once

#include <vector>

#include "common/core/result.h"
#include "patient_site/force_table.h"
#include "patient_site/phantom.h"
#include "study/study_file.h"

namespace palp::study {

/// A ball below 20,0 in the block that the database of finite elements has; lengths [m].
[[nodiscard]] Result<patient::Phantom> ball_phantom(double radius, double ratio, double depth);

/// The tissue of each of a study's levels, as force over indentation. Immutable; any thread.
class LevelCurves {
 public:
  /// Plain tissue, and for each level the same times e^level.
  LevelCurves();
  /// Above a study's ball, where it has one: of each of its depths as the database has it; of a
  /// ranking at those between that its levels mean. A sentence where the database does not reach so
  /// far.
  [[nodiscard]] static Result<LevelCurves> make(const Study& study);

  /// Of a ball: at the depth with the nearest level; else 0 is plain tissue.
  [[nodiscard]] patient::ForceTable at(double level) const;
  /// A study's ball at the depth with the nearest level, below that place.
  [[nodiscard]] patient::Phantom hiding(double level, const Place& axis) const;

 private:
  struct BallCurve {
    double level{};  ///< [-]
    patient::ForceTable table;
    patient::Phantom phantom;
  };
  [[nodiscard]] const BallCurve& nearest(double level) const;

  patient::ForceTable plain_;
  std::vector<BallCurve> balls_;  ///< none: plain tissue made stiffer
  bool has_plain_{true};          ///< level 0 is plain tissue, not a ball
};

}  // namespace palp::study
