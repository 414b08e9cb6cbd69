#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/core/place.h"
#include "common/core/result.h"
#include "common/message/depth.h"
#include "depth/depth_database.h"
#include "depth/map_verdict.h"
#include "lab/plan/locate_search.h"
#include "lab/plan/locate_session.h"
#include "lab/plan/locate_taps.h"
#include "lab/plan/mismatched_world.h"

namespace palp::lab {

/// Monte Carlo of maps: phantoms of one ball somewhere below a plane surface, and plain ones, each
/// tapped once at every place of a square pattern. Stage, tissue and sensor are simulated, the
/// tracker cuts the strokes, one posterior judges all of them; hand and network only on demand.
struct LocateStudy {
  std::uint32_t count{100};  ///< phantoms with a ball, and as many plain ones
  std::uint64_t seed{1};
  std::uint32_t rows{3};        ///< of the pattern, and as many columns
  double pitch{7.5e-3};         ///< [m]
  double spread{};              ///< [-], of the tissue's stiffness from place to place
  double length{10e-3};         ///< [m], over which it varies; 0: by each place of a pattern anew
  double assumed_spread{0.05};  ///< [-], of it, by the estimator
  double modulus{kDatabaseModulus};  ///< [Pa], Young's, of the tissue within 10 %
  double told{kDatabaseModulus};     ///< [Pa], what the estimator is told of it
  double depth_max{27e-3};           ///< [m], of the balls drawn
  /// The one ball of all cases; nothing: drawn from what the estimator assumes.
  std::optional<depth::DepthDatabase::Query> ball{};
  std::optional<Place> axis{};  ///< of all balls, from the pattern's middle; nothing: drawn
  bool mismatch{};              ///< `count` worlds that are not as assumed instead
  /// A field palpated tap by tap instead of the pattern, by that rule.
  std::optional<TapRule> rule{};
  /// Whole sessions with that script; empty: the taps alone.
  std::string script{};
  double round_trip{};              ///< [s], of these
  double loss{};                    ///< [-], of these, each way
  std::function<double()> clock{};  ///< [s], to time the answers; null: nobody does
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
  Mismatch kind{};  ///< of a world that is not as assumed
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
  std::uint32_t strokes{};   ///< of a session
  double update{};           ///< [s], from the last tap to the answer; 0: not timed
  Searched searched{};       ///< of a field palpated by a rule

  /// An inclusion where there is none, or an interval of x, y, depth or radius that misses the
  /// truth, and not a word of doubt.
  [[nodiscard]] bool confidently_wrong() const;
  /// Found without a doubt: x, y and depth within 1 mm, and the radius within its interval.
  [[nodiscard]] bool right() const;
};

/// What all cases share. Immutable; any thread.
class LocateBench {
 public:
  [[nodiscard]] static Result<LocateBench> make(const LocateStudy& study);
  [[nodiscard]] LocateCase run(std::uint32_t index) const;

 private:
  LocateBench(const LocateStudy& study, depth::DepthDatabase database);
  [[nodiscard]] std::vector<depth::PlaceData> touch_all(const Palpation::TapAt& tap_at) const;
  [[nodiscard]] std::string words_of(const LocatePhantom& truth,
                                     bool inclusion,
                                     LocateDraws& draws) const;
  [[nodiscard]] std::vector<depth::PlaceData> touch_by_rule(const LocatePhantom& truth,
                                                            LocateDraws& draws,
                                                            LocateCase& out) const;
  [[nodiscard]] std::vector<depth::PlaceData> touch_as_assumed(const LocatePhantom& truth,
                                                               bool inclusion,
                                                               LocateDraws& draws) const;
  [[nodiscard]] std::vector<depth::PlaceData> touch_tissue(
      const std::string& words,
      const patient::SimulatedPhantomConfig& config,
      LocateDraws& draws) const;
  void run_session(const LocatePhantom& truth, LocateDraws& draws, LocateCase& out) const;
  void judge(const LocatePhantom& truth,
             std::vector<depth::PlaceData> places,
             LocateCase& out) const;

  LocateStudy study_;
  depth::DepthDatabase database_;
  depth::MapPrior prior_;
  depth::BallField field_;
  depth::CurveBasis basis_;
};

/// Of such a ball, as "depth=10 radius=15 ratio=856 at=2,1", in mm; a sentence if there is none.
[[nodiscard]] Result<void> take_ball(const std::string& words, LocateStudy& study);

/// Cases in order of their index.
[[nodiscard]] std::uint32_t case_count(const LocateStudy& study);
[[nodiscard]] std::string locate_table(const LocateStudy& study,
                                       const std::vector<LocateCase>& cases);
[[nodiscard]] std::string locate_report(const LocateStudy& study,
                                        const std::vector<LocateCase>& cases,
                                        const std::string& cases_csv);
[[nodiscard]] std::string locate_csv(const LocateStudy& study,
                                     const std::vector<LocateCase>& cases);

}  // namespace palp::lab
