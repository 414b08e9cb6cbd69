#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "patient_site/estimator/depth_posterior.h"
#include "patient_site/estimator/paper_estimator.h"

namespace palp::estimator {

struct BayesEstimatorConfig {
  PaperEstimatorConfig strokes;
  /// Shallower says too little. Less than eq. (2) needs: no cubic is fitted.
  double indentation_min{1.5e-3};  ///< [m]
  DepthPrior prior;
  StiffnessPrior stiffness;       ///< before anything was touched
  double evidence_min{2};         ///< [-], log of the odds from which an inclusion is found
  double gain_min{9};             ///< [-], and what the best one must gain: 3 sigma
  double reference_spread{1e-3};  ///< [-], of the block's stiffness from place to place
};

/// The estimator that knows how sure it is. Strokes are cut and cleaned as the paper's estimator
/// does, strokes at one place add up, and each new one updates the posterior over depth, radius and
/// stiffness ratio of a depth database. The first place that was touched is the reference: what it
/// says of the block's stiffness is the prior everywhere else, unless a softer place turns up.
/// Thread: estimator; allocates.
class BayesEstimator {
 public:
  BayesEstimator(const fem::DepthDatabase& database, const BayesEstimatorConfig& config);

  /// @returns the estimate when a stroke's reversal was seen.
  [[nodiscard]] std::optional<DepthEstimate> add(const ContactSample& sample);

  [[nodiscard]] std::span<const StrokeSample> stroke() const noexcept { return strokes_.stroke(); }
  /// Of the last estimate that was not invalid.
  [[nodiscard]] const DepthPosterior& posterior() const noexcept { return posterior_; }

 private:
  /// Touches of one place that were added up and are not looked at again.
  struct Settled {
    double lateral{};  ///< [m]
    std::uint64_t generation{};
    std::size_t count{};   ///< of the generation's touches, settled or too early for it
    std::size_t weight{};  ///< [touches], in the sums
    NormalEquations sums{0};
    std::optional<TouchModel> best;  ///< nothing: no answer yet
  };

  void judge(DepthEstimate& estimate, const PaperEstimator::PlaceData& place);
  [[nodiscard]] Settled& settled_at(const PaperEstimator::PlaceData& place);
  void settle(const PaperEstimator::PlaceData& place, DepthModel::Input& input, Settled& settled);

  struct Reference {
    double lateral{};  ///< [m]
    StiffnessPrior stiffness;
  };

  BayesEstimatorConfig config_;
  PaperEstimator strokes_;
  DepthModel model_;
  std::optional<Reference> reference_;
  std::vector<Settled> settled_;  ///< the places touched last
  DepthPosterior posterior_;
};

}  // namespace palp::estimator
