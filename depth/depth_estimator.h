#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "depth/bayes_estimator.h"
#include "depth/depth_database.h"
#include "depth/paper_estimator.h"
#include "depth/stroke_tracker.h"

namespace palp::depth {

enum class EstimatorKind { Bayes, Paper };

[[nodiscard]] constexpr std::string_view to_string(EstimatorKind kind) noexcept {
  return kind == EstimatorKind::Bayes ? "bayes" : "paper";
}

struct DepthEstimatorConfig {
  EstimatorKind kind{EstimatorKind::Bayes};
  StrokeTrackerConfig strokes;
  BayesEstimatorConfig bayes;
  PaperEstimatorConfig paper;
  std::optional<DepthDatabase> database;  ///< nothing: the one in the program
};

/// `config` for strokes felt by that sensor.
[[nodiscard]] DepthEstimatorConfig with_sensor(DepthEstimatorConfig config,
                                               const ForceSensorFacts& sensor);

/// Samples in, a depth for each stroke out: a tracker cuts the strokes, one of two estimators
/// judges them. Thread: estimator; allocates.
class DepthEstimator {
 public:
  explicit DepthEstimator(const DepthEstimatorConfig& config);

  /// @returns the estimate when a stroke's reversal was seen.
  [[nodiscard]] std::optional<DepthEstimate> add(const ContactSample& sample);

  /// The loading branch that gave an estimate. Valid until the next add().
  [[nodiscard]] std::span<const StrokeSample> stroke() const noexcept { return tracker_.loading(); }

 private:
  StrokeTracker tracker_;
  std::variant<BayesEstimator, PaperEstimator> estimator_;
};

}  // namespace palp::depth
