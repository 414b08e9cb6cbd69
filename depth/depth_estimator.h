#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "depth/bayes_estimator.h"
#include "depth/depth_database.h"
#include "depth/map_estimator.h"
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
  MapEstimatorConfig map;
  std::optional<DepthDatabase> database;  ///< nothing: the one in the program
};

/// `config` for strokes felt by that sensor, within the reach of that stage.
[[nodiscard]] DepthEstimatorConfig with_devices(DepthEstimatorConfig config,
                                                const PatientDevices& devices);

/// Samples in, a depth for each stroke out: a tracker cuts the strokes, one of two estimators
/// judges them. `bayes` for balls also says what the strokes at all places mean together.
/// Thread: estimator; allocates.
class DepthEstimator {
 public:
  explicit DepthEstimator(const DepthEstimatorConfig& config);

  /// @returns the estimate when a stroke's reversal was seen.
  /// A sample of another session forgets all before.
  [[nodiscard]] std::optional<DepthEstimate> add(const ContactSample& sample);

  /// What all strokes say together, where the last one tells something new of it: a longer work.
  [[nodiscard]] std::optional<MapReport> map() { return map_ ? map_->judge() : std::nullopt; }

  /// The stiffness map behind it, cell by cell.
  [[nodiscard]] std::vector<MapCell> map_cells() const {
    return map_ ? map_->cells() : std::vector<MapCell>{};
  }

  /// The loading branch that gave an estimate. Valid until the next add().
  [[nodiscard]] std::span<const StrokeSample> stroke() const noexcept { return tracker_.loading(); }

 private:
  void forget();

  StrokeTracker tracker_;
  std::uint64_t session_{};
  std::variant<BayesEstimator, PaperEstimator> estimator_;
  std::optional<MapEstimator> map_;  ///< nothing: of `paper`, and of cylinders
};

}  // namespace palp::depth
