#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/message/map_report.h"
#include "depth/depth_database.h"
#include "depth/map_likelihood.h"
#include "depth/map_posterior.h"
#include "depth/map_verdict.h"
#include "depth/next_touch.h"
#include "depth/stroke_tracker.h"

namespace palp::depth {

struct MapEstimatorConfig {
  double place_spread{0.05};  ///< [-], of the tissue's stiffness from place to place
  double travel{45e-3};       ///< [m], no touch is proposed farther from the middle, along x and y
  double known{1e-3};         ///< [m], standard deviation of x, y and depth that is good enough
  double news{0.03};          ///< [nat], a touch that tells less is not worth it
  MapVerdictConfig verdict;
};

/// Whether one more touch is worth it.
[[nodiscard]] MapStop map_stop(const MapPosterior& posterior,
                               const MapVerdict& verdict,
                               const std::optional<NextTouch>& next,
                               const MapEstimatorConfig& config) noexcept;

/// Fewer places say nothing of where a ball lies: the single place has an estimator of its own.
inline constexpr std::size_t kMapPlacesMin = 3;

/// Where the inclusion lies, how large it is and how sure that is, from the strokes at all places
/// since the tracker first heard of them. What a place said goes with it: a tissue that changed
/// there is another. Thread: estimator; allocates.
class MapEstimator {
 public:
  /// `ball`, `stiffness`: as the estimator of the single place has them; balls alone.
  /// `strokes`: of the tracker whose strokes are heard.
  MapEstimator(DepthDatabase database,
               const DepthPrior& ball,
               const StiffnessPrior& stiffness,
               const MapEstimatorConfig& config,
               const StrokeTrackerConfig& strokes);

  /// The stroke's touches, a millisecond's work.
  void hear(const Stroke& stroke);

  /// Another patient: no place was touched.
  void forget();

  /// What all strokes so far say together; nothing where no stroke has come since, or of too few
  /// places. Tens of milliseconds, the first time more.
  [[nodiscard]] std::optional<MapReport> judge();

  /// The stiffness map of the last answer, with its number; empty: there was none.
  [[nodiscard]] std::vector<MapCell> cells() const;

 private:
  /// What stands behind the last answer.
  struct Answer {
    MapLikelihood likelihood;
    MapPosterior posterior;
    MapVerdict verdict;
    std::optional<NextTouch> next;
  };
  /// What balls do to the force: made when it is first asked for.
  struct Parts {
    Parts(const DepthDatabase& database, const DepthPrior& ball);
    MapPrior prior;
    BallField field;
  };
  struct Touched {
    std::size_t index{};         ///< of the tracker's place
    std::uint64_t generation{};  ///< of its tissue
    PlaceData data;
  };
  [[nodiscard]] MapReport report() const;

  std::unique_ptr<const DepthDatabase> database_;  ///< stands still: the field refers to it
  DepthPrior ball_;
  StiffnessPrior stiffness_;
  MapEstimatorConfig config_;
  StrokeTrackerConfig strokes_;
  CurveBasis basis_;
  std::unique_ptr<const Parts> parts_;
  std::vector<Touched> touched_;
  std::uint32_t heard_{};   ///< number of the newest stroke
  std::uint32_t judged_{};  ///< of that in the last answer
  std::optional<Answer> answer_;
};

}  // namespace palp::depth
