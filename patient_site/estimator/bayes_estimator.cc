#include "patient_site/estimator/bayes_estimator.h"

#include <cmath>

namespace palp::estimator {
namespace {

constexpr double kSofter = 4;  // standard deviations from which another place is the reference

}  // namespace

BayesEstimator::BayesEstimator(const fem::DepthDatabase& database,
                               const BayesEstimatorConfig& config)
    : config_{config}, strokes_{config.strokes}, model_{database, config.prior} {}

std::optional<DepthEstimate> BayesEstimator::add(const ContactSample& sample) {
  std::optional<DepthEstimate> estimate = strokes_.add(sample);
  if (!estimate) return estimate;
  const auto place = strokes_.place();
  // What the paper's formula (3) cannot tell, this one may; what is no stroke stays none.
  const bool long_enough = estimate->reason == DepthReason::StrokeTooShort &&
                           estimate->indentation_max >= config_.indentation_min;
  const bool usable = estimate->reason == DepthReason::Ok ||
                      estimate->reason == DepthReason::HashOutOfRange || long_enough;
  if (usable && place) judge(*estimate, *place);
  return estimate;
}

void BayesEstimator::judge(DepthEstimate& estimate, const PaperEstimator::PlaceData& place) {
  DepthModel::Input input{.points = place.points,
                          .surface = place.surface,
                          .noise = place.noise,
                          .stiffness = config_.stiffness};
  const bool here =
      reference_ && std::abs(reference_->lateral - place.lateral) <= config_.strokes.place_size;
  if (reference_ && !here) {
    input.stiffness = reference_->stiffness;
    input.stiffness.scale_stddev =
        std::hypot(input.stiffness.scale_stddev, config_.reference_spread * input.stiffness.scale);
  }
  posterior_ = model_.update(input);
  const StiffnessPrior& plain = posterior_.plain;
  if (!reference_ || here) {
    reference_ = Reference{place.lateral, plain};
  } else {
    const double spread = std::hypot(plain.scale_stddev, reference_->stiffness.scale_stddev);
    if (plain.scale < reference_->stiffness.scale - kSofter * spread) {
      reference_ = Reference{place.lateral, plain};
    }
  }
  const bool found =
      posterior_.log_evidence > config_.evidence_min && posterior_.gain > config_.gain_min;
  estimate.verdict = found ? DepthVerdict::Found : DepthVerdict::None;
  estimate.reason = DepthReason::Ok;
  estimate.depth = found ? posterior_.depth : 0;
  estimate.depth_stddev = found ? posterior_.depth_stddev : 0;
  estimate.depth_low = found ? posterior_.depth_low : posterior_.excluded;
  estimate.depth_high = found ? posterior_.depth_high : 0;
  estimate.fit_rms = posterior_.misfit;
}

}  // namespace palp::estimator
