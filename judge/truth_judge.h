#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "common/message/plant_truth.h"
#include "judge/pause_probe.h"
#include "judge/run_judge.h"

namespace palp::judge {

/// Judges a simulated session by what is true in it, tick by tick: in the lab as it runs, and again
/// from its file, with the same answer to the last bit. Thread: any one.
class TruthJudge {
 public:
  /// `config`: without a blackout, which is found.
  explicit TruthJudge(const MetricsConfig& config) : run_{config} {}

  /// Of every tick since the run began, also those of no script. `told_short`: the surgeon's site
  /// says that the force is incomplete. @returns the tick as it was
  /// judged; nothing: no script was performed in it.
  std::optional<RunTick> look(const PlantTruth& truth, bool told_short = false);

  [[nodiscard]] RunMetrics metrics() const;

 private:
  /// [N], against 10 ticks ago, or the oldest since the force became the site's own.
  [[nodiscard]] double force_step(double force);

  RunJudge run_;
  double work_min_{};  ///< [J]
  double net_min_{};   ///< [J]
  PauseProbe pauses_;
  std::deque<double> forces_;  ///< [N], newest last
  double step_max_{};          ///< [N]
  bool dark_seen_{};
};

}  // namespace palp::judge
