#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "depth/curve_lattice.h"
#include "depth/depth_database.h"
#include "depth/sensor_steps.h"
#include "depth/touch.h"

namespace palp::depth {

/// Samples count to here: nowhere deeper does the database reach.
inline constexpr double kDeepestPoint = kCurveReach - 0.05e-3;  // [m]

/// The force of the block without inclusion, tabulated, times the polynomials of CurveTerms.
/// A value, immutable after construction.
class CurveBasis {
 public:
  explicit CurveBasis(const DepthDatabase& database);
  struct Row {
    CurveTerms force{};  ///< [N]
    CurveTerms slope{};  ///< [N/m]
  };
  [[nodiscard]] Row at(double indentation) const noexcept;  ///< [m]; zero in the air

 private:
  std::vector<Row> rows_;
};

/// A curve with the three numbers in which the force is linear. At an indentation x and its rate:
/// force = scale * F(x - shift) * (1 + rate_factor * rate), F being the curve's.
struct TouchModel {
  CurveTerms curve{kPlainTerms};
  double surface{};      ///< [m]
  double scale{1};       ///< [-]
  double rate_factor{};  ///< [s/m]
};

/// Samples of strokes at one place, seen from one surface, reduced to what every curve needs of
/// them: a match then costs some hundred multiplications, however many samples there were. The
/// force depends on (scale, scale * shift, scale * rate factor), each times the curve's terms;
/// these are its normal equations. The forces of the terms pass the transducer's pole, as the
/// measured force did.
/// A value. Thread: estimator.
class NormalEquations {
 public:
  static constexpr std::size_t kUnknowns = 3;
  static constexpr std::size_t kColumns = kUnknowns * kCurveTerms;
  using Columns = std::array<double, kColumns>;

  explicit NormalEquations(double surface) : surface_{surface} {}  ///< [m]

  /// What every touch at a place shares.
  struct Reading {
    const CurveBasis& basis;
    const SensorSteps& steps;
    double cut_off{};                    ///< [Hz], of the transducer's pole; 0: none
    double noise{};                      ///< [N], rms of a sample, for want of `expected`
    std::optional<TouchModel> expected;  ///< what the steps make of a force needs the force
  };
  void add(std::span<const TouchSample> touch, const Reading& reading);
  void add(const NormalEquations& other) noexcept;  ///< seen from the same surface
  void scale(double factor) noexcept;               ///< of every weight: forget in part
  /// As if seen from a surface near the present one [m].
  void move_to(double surface) noexcept;

  [[nodiscard]] double surface() const noexcept { return surface_; }  ///< [m]
  [[nodiscard]] double weights() const noexcept { return weights_; }  ///< [1/N^2], of all samples
  [[nodiscard]] double squares() const noexcept { return squares_; }  ///< [-], of the force
  [[nodiscard]] double samples() const noexcept {
    return samples_;
  }  ///< so many, those forgotten out
  /// Of unknown i: the measured force's share along the curve.
  [[nodiscard]] double along(std::size_t i, const CurveTerms& curve) const noexcept;
  /// Of unknown i and a curve: what it shares with the columns of i and of the unknowns behind.
  [[nodiscard]] Columns rows(std::size_t i, const CurveTerms& curve) const noexcept;
  /// Of such rows, unknown j and a second curve.
  [[nodiscard]] static double between(const Columns& rows,
                                      std::size_t j,
                                      const CurveTerms& curve) noexcept;

 private:
  void add(const Columns& columns, double weight) noexcept;

  double surface_;                          ///< [m]
  double weights_{};                        ///< [1/N^2]
  double squares_{};                        ///< [-]
  double samples_{};                        ///< [-]
  std::array<Columns, kColumns> matrix_{};  ///< blocks i <= j
  Columns right_{};
};

}  // namespace palp::depth
