#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "depth/map_verdict.h"

namespace palp::lab {

/// Monte Carlo of maps: phantoms of one ball somewhere below a plane surface, and plain ones, each
/// tapped once at every place of a square pattern. Stage, tissue and sensor are simulated, the
/// tracker cuts the strokes, one posterior judges all of them; no hand and no network.
struct LocateStudy {
  std::uint32_t count{100};  ///< phantoms with a ball, and as many plain ones
  std::uint64_t seed{1};
  std::uint32_t rows{3};        ///< of the pattern, and as many columns
  double pitch{7.5e-3};         ///< [m]
  double spread{};              ///< [-], of the tissue's stiffness from place to place
  double assumed_spread{0.05};  ///< [-], of it, by the estimator
  double depth_max{27e-3};      ///< [m], of the balls drawn
};

/// Of a coordinate: x, y, depth, radius [m], logarithm of the ratio [-].
inline constexpr std::size_t kLocated = depth::kBallCoordinates;
inline constexpr std::array<const char*, kLocated> kLocatedNames{
    "x_mm", "y_mm", "depth_mm", "radius_mm", "log_ratio"};
struct Located {
  double truth{};   ///< [as the coordinate]
  double median{};  ///< [as the coordinate]
  double low{};     ///< [as the coordinate]
  double high{};    ///< [as the coordinate]
  double bound{};   ///< [as the coordinate]
};

/// One phantom and what was said of it.
struct LocateCase {
  std::uint32_t index{};
  bool inclusion{};
  bool found{};
  std::uint32_t doubts{};  ///< a bit for each
  std::array<Located, kLocated> coordinates{};
  double ratio{};            ///< [-], true
  double scale{1};           ///< [-], of Young's modulus
  double log_evidence{};     ///< [-]
  double balls_worth{};      ///< [-]
  double worst_curve{};      ///< [-]
  double worst_deviation{};  ///< [-]
};

struct LocatePhantom;
class LocateDraws;

/// What all cases share. Immutable; any thread.
class LocateBench {
 public:
  [[nodiscard]] static Result<LocateBench> make(const LocateStudy& study);
  [[nodiscard]] LocateCase run(std::uint32_t index) const;

 private:
  LocateBench(const LocateStudy& study, depth::DepthDatabase database);
  [[nodiscard]] std::vector<depth::PlaceData> touch_all(const LocatePhantom& truth,
                                                        bool inclusion,
                                                        LocateDraws& draws) const;

  LocateStudy study_;
  depth::DepthDatabase database_;
  depth::MapPrior prior_;
  depth::BallField field_;
  depth::CurveBasis basis_;
};

/// Cases in order of their index.
[[nodiscard]] std::uint32_t case_count(const LocateStudy& study);
[[nodiscard]] std::string locate_table(const LocateStudy& study,
                                       const std::vector<LocateCase>& cases);
[[nodiscard]] std::string locate_report(const LocateStudy& study,
                                        const std::vector<LocateCase>& cases,
                                        const std::string& cases_csv);
[[nodiscard]] std::string locate_csv(const std::vector<LocateCase>& cases);

}  // namespace palp::lab
