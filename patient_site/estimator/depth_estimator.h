#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "fem/depth_database.h"
#include "patient_site/estimator/bayes_estimator.h"

namespace palp::estimator {

enum class EstimatorKind { Bayes, Paper };

[[nodiscard]] constexpr std::string_view to_string(EstimatorKind kind) noexcept {
  return kind == EstimatorKind::Bayes ? "bayes" : "paper";
}

struct DepthEstimatorConfig {
  EstimatorKind kind{EstimatorKind::Bayes};
  BayesEstimatorConfig bayes;  ///< with the strokes' settings, which the paper's uses as well
  std::optional<fem::DepthDatabase> database;  ///< nothing: the one in the program
};

/// `config` for strokes felt by that sensor.
[[nodiscard]] DepthEstimatorConfig with_sensor(DepthEstimatorConfig config,
                                               const ForceSensorFacts& sensor);

/// Strokes in, a depth out, by one of two ways. Thread: estimator; allocates.
class DepthEstimator {
 public:
  explicit DepthEstimator(const DepthEstimatorConfig& config);

  /// @returns the estimate when a stroke's reversal was seen.
  [[nodiscard]] std::optional<DepthEstimate> add(const ContactSample& sample);

  /// The loading branch that gave an estimate. Valid until the next add().
  [[nodiscard]] std::span<const StrokeSample> stroke() const noexcept;

 private:
  std::variant<BayesEstimator, PaperEstimator> estimator_;
};

}  // namespace palp::estimator
