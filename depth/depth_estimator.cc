#include "depth/depth_estimator.h"

#include <algorithm>

#include "common/core/check.h"

namespace palp::depth {
namespace {

/// The one in the program is read once.
const DepthDatabase& database_of(const DepthEstimatorConfig& config) {
  if (config.database) return *config.database;
  static const Result<DepthDatabase> built_in = default_database();
  PALP_CHECK(built_in.has_value(), "the database in the program is sound");
  return *built_in;
}

std::variant<BayesEstimator, PaperEstimator> make(const DepthEstimatorConfig& config) {
  if (config.kind == EstimatorKind::Paper) return PaperEstimator{config.paper};
  return BayesEstimator{database_of(config), config.bayes, config.strokes};
}

std::optional<MapEstimator> make_map(const DepthEstimatorConfig& config) {
  const DepthPrior& prior = config.bayes.prior;
  if (config.kind == EstimatorKind::Paper || prior.shape != fem::InclusionShape::Ball) {
    return std::nullopt;
  }
  return MapEstimator{
      database_of(config), prior, config.bayes.stiffness, config.map, config.strokes};
}

}  // namespace

DepthEstimatorConfig with_devices(DepthEstimatorConfig config, const PatientDevices& devices) {
  config.strokes.sensor = devices.sensor;
  config.strokes.stage_rate = devices.stage.rate;
  config.map.travel = std::min(config.map.travel, devices.stage.travel_side);
  return config;
}

DepthEstimator::DepthEstimator(const DepthEstimatorConfig& config)
    : tracker_{config.strokes}, estimator_{make(config)}, map_{make_map(config)} {}

void DepthEstimator::forget() {
  tracker_.forget();
  if (auto* bayes = std::get_if<BayesEstimator>(&estimator_)) bayes->forget();
  if (map_) map_->forget();
}

std::optional<DepthEstimate> DepthEstimator::add(const ContactSample& sample) {
  if (sample.session != session_) forget();
  session_ = sample.session;
  const std::optional<Stroke> stroke = tracker_.take(sample);
  if (!stroke) return std::nullopt;
  if (map_) map_->hear(*stroke);
  return std::visit([&](auto& estimator) { return estimator.judge(*stroke); }, estimator_);
}

}  // namespace palp::depth
