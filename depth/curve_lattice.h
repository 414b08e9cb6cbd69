#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/result.h"
#include "depth/depth_database.h"

namespace palp::depth {

/// What is known of an inclusion before it was touched: by default no more than that the database
/// has it. Equal ends: known exactly.
struct DepthPrior {
  double depth_min{3e-3};    ///< [m], uniform between
  double depth_max{27e-3};   ///< [m]
  double radius_min{3e-3};   ///< [m], uniform between
  double radius_max{16e-3};  ///< [m]
  double ratio_min{3};       ///< [-], uniform in the logarithm
  double ratio_max{900};     ///< [-]
  fem::InclusionShape shape{fem::InclusionShape::Ball};
};

/// The part of a prior that a database knows of. A sentence where it knows of nothing in it.
[[nodiscard]] Result<DepthPrior> known_part(const DepthPrior& prior, const fem::DepthGrid& grid);

/// A curve as a few numbers: force = plain force * sum of c_m P_m(indentation).
inline constexpr std::size_t kCurveTerms = 7;
using CurveTerms = std::array<double, kCurveTerms>;

/// The curve of the block without inclusion.
inline constexpr CurveTerms kPlainTerms{1};

inline constexpr double kCurveReach = 4.6e-3;  ///< [m], to where the terms are fitted

/// P_m at an indentation [m]: Chebyshev's polynomials over 0 to kCurveReach; P_0 = 1.
[[nodiscard]] CurveTerms curve_polynomials(double indentation) noexcept;

/// Even nodes of one coordinate, with cubic interpolation between; one node: a constant.
struct NodeAxis {
  double low{};   ///< [as the coordinate]
  double step{};  ///< [as the coordinate]
  std::size_t count{1};
  struct Weights {
    std::size_t first{};
    std::array<double, 4> weight{};  ///< [-]
  };
  [[nodiscard]] Weights at(double x) const noexcept;
  [[nodiscard]] double high() const noexcept { return low + step * static_cast<double>(count - 1); }
  [[nodiscard]] double node(std::size_t i) const noexcept {
    return low + step * static_cast<double>(i);
  }
};

/// In these coordinates curves change evenly: the logarithm of the depth, the radius, and what a
/// ball of the ratio does to the field far from it, (k - 1)/(k + 1.5).
[[nodiscard]] constexpr double effect_of(double ratio) noexcept {
  return (ratio - 1) / (ratio + 1.5);
}
[[nodiscard]] constexpr double ratio_of(double effect) noexcept {
  return (1 + 1.5 * effect) / (1 - effect);
}

/// All curves of one radius and one effect, over a range of depths.
class CurveLine {
 public:
  static constexpr std::size_t kDepths = 56;
  [[nodiscard]] CurveTerms at(double log_depth) const noexcept;

 private:
  friend class CurveLattice;
  NodeAxis depth_;       ///< log of m
  std::size_t first_{};  ///< node of the first terms
  std::size_t count_{};
  std::array<CurveTerms, kDepths> terms_{};  ///< of which count_ mean something
};

/// The curves of a depth database within a prior, shortened to terms and so dense that a cubic
/// between them is as good as the database itself: a curve costs a hundred nanoseconds.
/// A value, immutable after construction. Thread: estimator.
class CurveLattice {
 public:
  CurveLattice(const DepthDatabase& database, const DepthPrior& prior);

  [[nodiscard]] CurveTerms at(double log_depth, double radius, double effect) const noexcept;
  /// Logarithms of depths from `low` to `high` are good.
  [[nodiscard]] CurveLine line(double radius,
                               double effect,
                               double low,
                               double high) const noexcept;
  [[nodiscard]] const NodeAxis& log_depths() const noexcept { return depth_; }
  [[nodiscard]] const NodeAxis& radii() const noexcept { return radius_; }    ///< [m]
  [[nodiscard]] const NodeAxis& effects() const noexcept { return effect_; }  ///< [-]

 private:
  NodeAxis depth_;
  NodeAxis radius_;
  NodeAxis effect_;
  std::vector<CurveTerms> terms_;  ///< by radius, effect, depth
};

}  // namespace palp::depth
