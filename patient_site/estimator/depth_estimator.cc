#include "patient_site/estimator/depth_estimator.h"

#include "common/core/check.h"

namespace palp::estimator {
namespace {

std::variant<BayesEstimator, PaperEstimator> make(const DepthEstimatorConfig& config) {
  if (config.kind == EstimatorKind::Paper) return PaperEstimator{config.bayes.strokes};
  if (config.database) return BayesEstimator{*config.database, config.bayes};
  const auto database = fem::default_database();
  PALP_CHECK(database.has_value(), "the database in the program is sound");
  return BayesEstimator{*database, config.bayes};
}

}  // namespace

DepthEstimatorConfig with_sensor(DepthEstimatorConfig config, const ForceSensorFacts& sensor) {
  config.bayes.strokes.sensor = sensor;
  return config;
}

DepthEstimator::DepthEstimator(const DepthEstimatorConfig& config) : estimator_{make(config)} {}

std::optional<DepthEstimate> DepthEstimator::add(const ContactSample& sample) {
  return std::visit([&](auto& estimator) { return estimator.add(sample); }, estimator_);
}

std::span<const StrokeSample> DepthEstimator::stroke() const noexcept {
  return std::visit([](const auto& estimator) { return estimator.stroke(); }, estimator_);
}

}  // namespace palp::estimator
