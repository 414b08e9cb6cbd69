#include "depth/depth_estimator.h"

#include "common/core/check.h"

namespace palp::depth {
namespace {

std::variant<BayesEstimator, PaperEstimator> make(const DepthEstimatorConfig& config) {
  if (config.kind == EstimatorKind::Paper) return PaperEstimator{config.paper};
  if (config.database) return BayesEstimator{*config.database, config.bayes, config.strokes};
  const auto database = default_database();
  PALP_CHECK(database.has_value(), "the database in the program is sound");
  return BayesEstimator{*database, config.bayes, config.strokes};
}

}  // namespace

DepthEstimatorConfig with_sensor(DepthEstimatorConfig config, const ForceSensorFacts& sensor) {
  config.strokes.sensor = sensor;
  return config;
}

DepthEstimator::DepthEstimator(const DepthEstimatorConfig& config)
    : tracker_{config.strokes}, estimator_{make(config)} {}

std::optional<DepthEstimate> DepthEstimator::add(const ContactSample& sample) {
  const std::optional<Stroke> stroke = tracker_.take(sample);
  if (!stroke) return std::nullopt;
  return std::visit([&](auto& estimator) { return estimator.judge(*stroke); }, estimator_);
}

}  // namespace palp::depth
