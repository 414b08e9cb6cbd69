#include "depth/bayes_estimator.h"

#include <algorithm>
#include <cmath>

namespace palp::depth {
namespace {

constexpr double kSofter = 4;  // standard deviations from which another place is the reference
constexpr std::size_t kTouchesFresh = 5;  // of a place, looked at anew with each answer
static_assert(kTouchesFresh < kTouchesKept);
constexpr std::size_t kWeightMax = 32;  // touches; then what is settled is half forgotten

}  // namespace

BayesEstimator::BayesEstimator(const DepthDatabase& database,
                               const BayesEstimatorConfig& config,
                               const StrokeTrackerConfig& strokes)
    : config_{config}, strokes_{strokes}, model_{database, config.prior} {}

DepthEstimate BayesEstimator::judge(const Stroke& stroke) {
  DepthEstimate estimate = unjudged(stroke);
  if (stroke.reason != DepthReason::Ok) return estimate;
  if (stroke.indentation_max < config_.indentation_min) {
    estimate.reason = DepthReason::StrokeTooShort;
    return estimate;
  }
  update(stroke.known);
  const bool found =
      posterior_.log_evidence > config_.evidence_min && posterior_.gain > config_.gain_min;
  estimate.verdict = found ? DepthVerdict::Found : DepthVerdict::None;
  estimate.depth = found ? posterior_.depth : 0;
  estimate.depth_stddev = found ? posterior_.depth_stddev : 0;
  estimate.depth_low = found ? posterior_.depth_low : posterior_.excluded;
  estimate.depth_high = found ? posterior_.depth_high : 0;
  estimate.fit_rms = posterior_.misfit;
  return estimate;
}

void BayesEstimator::forget() {
  reference_.reset();
  settled_.clear();
}

void BayesEstimator::update(const TouchedPlace& place) {
  DepthModel::Input input{.touches = place.touches,
                          .surface = place.surface,
                          .noise = place.noise,
                          .quantum = strokes_.sensor.step,
                          .cut_off = strokes_.sensor.pole,
                          .stiffness = config_.stiffness,
                          .expected = {}};
  Settled& settled = settled_at(place);
  settle(place, input, settled);
  const bool here = reference_ && strokes_.same_place(reference_->place, place.place);
  if (reference_ && !here) {
    input.stiffness = reference_->stiffness;
    input.stiffness.scale_stddev =
        std::hypot(input.stiffness.scale_stddev, config_.reference_spread * input.stiffness.scale);
  }
  posterior_ = model_.update(input);
  settled.best = posterior_.best;
  learn_reference(place, here);
}

/// The first place is the reference, and later one that is plainly softer.
void BayesEstimator::learn_reference(const TouchedPlace& place, bool here) {
  const StiffnessPrior& plain = posterior_.plain;
  if (reference_ && !here) {
    const double spread = std::hypot(plain.scale_stddev, reference_->stiffness.scale_stddev);
    if (!(plain.scale < reference_->stiffness.scale - kSofter * spread)) return;
  }
  reference_ = Reference{place.place, plain};
}

BayesEstimator::Settled& BayesEstimator::settled_at(const TouchedPlace& place) {
  if (settled_.size() <= place.index) settled_.resize(place.index + 1);
  Settled& settled = settled_[place.index];
  if (settled.generation != place.generation) {
    settled =
        Settled{.generation = place.generation, .sums = NormalEquations{place.surface}, .best = {}};
  }
  return settled;
}

/// All but the last touches: their surface is known, and they need not be looked at again.
void BayesEstimator::settle(const TouchedPlace& place, DepthModel::Input& input, Settled& settled) {
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

}  // namespace palp::depth
