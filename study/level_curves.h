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
  /// Above a study's ball, where it has one: of each of its depths as the database has it. A
  /// sentence where the database does not reach so far.
  [[nodiscard]] static Result<LevelCurves> make(const Study& study);

  /// At 0 plain tissue. Of a ball: at the depth with the nearest level.
  [[nodiscard]] patient::ForceTable at(double level) const;

 private:
  struct BallCurve {
    double level{};  ///< [-]
    patient::ForceTable table;
  };

  patient::ForceTable plain_;
  std::vector<BallCurve> balls_;  ///< none: plain tissue made stiffer
};

}  // namespace palp::study
