#include "patient_site/estimator/bayes_estimator.h"

#include <algorithm>
#include <cmath>

namespace palp::estimator {
namespace {

constexpr double kSofter = 4;  // standard deviations from which another place is the reference
constexpr std::size_t kTouchesFresh = 5;  // of a place, looked at anew with each answer
static_assert(kTouchesFresh < PaperEstimator::kTouchesKept);
constexpr std::size_t kWeightMax = 32;  // touches; then what is settled is half forgotten
constexpr std::size_t kPlacesMax = 32;

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
  DepthModel::Input input{.touches = place.touches,
                          .surface = place.surface,
                          .noise = place.noise,
                          .quantum = config_.strokes.sensor.step,
                          .cut_off = config_.strokes.sensor.pole,
                          .stiffness = config_.stiffness,
                          .expected = {}};
  Settled& settled = settled_at(place);
  settle(place, input, settled);
  const bool here =
      reference_ && std::abs(reference_->lateral - place.lateral) <= config_.strokes.place_size;
  if (reference_ && !here) {
    input.stiffness = reference_->stiffness;
    input.stiffness.scale_stddev =
        std::hypot(input.stiffness.scale_stddev, config_.reference_spread * input.stiffness.scale);
  }
  posterior_ = model_.update(input);
  settled.best = posterior_.best;
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

BayesEstimator::Settled& BayesEstimator::settled_at(const PaperEstimator::PlaceData& place) {
  for (Settled& one : settled_) {
    if (one.lateral != place.lateral) continue;
    if (one.generation != place.generation) {
      one.generation = place.generation;
      one.count = one.weight = 0;
      one.sums = NormalEquations{place.surface};
      one.best.reset();
    }
    return one;
  }
  if (settled_.size() == kPlacesMax) settled_.erase(settled_.begin());
  return settled_.emplace_back(Settled{.lateral = place.lateral,
                                       .generation = place.generation,
                                       .sums = NormalEquations{place.surface},
                                       .best = {}});
}

/// All but the last touches: their surface is known, and they need not be looked at again.
void BayesEstimator::settle(const PaperEstimator::PlaceData& place,
                            DepthModel::Input& input,
                            Settled& settled) {
  const std::size_t forgotten = place.touched - place.touches.size();
  settled.count = std::max(settled.count, forgotten);
  if (settled.best && place.touched > settled.count + kTouchesFresh) {
    const std::size_t more = place.touched - kTouchesFresh - settled.count;
    input.touches = place.touches.subspan(settled.count - forgotten, more);
    model_.settle(input, *settled.best, settled.sums);
    settled.count += more;
    settled.weight += more;
  }
  if (settled.weight >= kWeightMax) {
    settled.sums.scale(0.5);
    settled.weight /= 2;
  }
  input.touches = place.touches.subspan(settled.count - forgotten);
  if (settled.weight > 0) input.settled = &settled.sums;
  input.expected = settled.best;
}

}  // namespace palp::estimator
