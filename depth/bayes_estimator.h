#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "depth/depth_posterior.h"
#include "depth/stroke_tracker.h"

namespace palp::depth {

struct BayesEstimatorConfig {
  /// Shallower says too little. Less than eq. (2) needs: no cubic is fitted.
  double indentation_min{1.5e-3};  ///< [m]
  DepthPrior prior;
  StiffnessPrior stiffness;       ///< before anything was touched
  double evidence_min{2};         ///< [-], log of the odds from which an inclusion is found
  double gain_min{9};             ///< [-], and what the best one must gain: 3 sigma
  double reference_spread{1e-3};  ///< [-], of the block's stiffness from place to place
};

/// The estimator that knows how sure it is. Strokes at one place add up, and each new one updates
/// the posterior over depth, radius and stiffness ratio of a depth database. The first place that
/// was touched is the reference: what it says of the block's stiffness is the prior everywhere
/// else, unless a softer place turns up. Thread: estimator; allocates.
class BayesEstimator {
 public:
  /// `strokes`: of the tracker whose strokes are judged.
  BayesEstimator(const DepthDatabase& database,
                 const BayesEstimatorConfig& config,
                 const StrokeTrackerConfig& strokes);

  [[nodiscard]] DepthEstimate judge(const Stroke& stroke);

  /// Another patient: no place is the reference.
  void forget();

  /// Of the last estimate that was not invalid.
  [[nodiscard]] const DepthPosterior& posterior() const noexcept { return posterior_; }

 private:
  /// Touches of one place that were added up and are not looked at again.
  struct Settled {
    std::uint64_t generation{};  ///< 0: none
    std::size_t count{};         ///< of the generation's touches, settled or too early for it
    std::size_t weight{};        ///< [touches], in the sums
    NormalEquations sums{0};
    std::optional<TouchModel> best;  ///< nothing: no answer yet
  };

  void update(const TouchedPlace& place);
  void learn_reference(const TouchedPlace& place, bool here);
  [[nodiscard]] Settled& settled_at(const TouchedPlace& place);
  void settle(const TouchedPlace& place, DepthModel::Input& input, Settled& settled);

  struct Reference {
    Place place;
    StiffnessPrior stiffness;
  };

  BayesEstimatorConfig config_;
  StrokeTrackerConfig strokes_;
  DepthModel model_;
  std::optional<Reference> reference_;
  std::vector<Settled> settled_;  ///< by place
  DepthPosterior posterior_;
};

}  // namespace palp::depth
