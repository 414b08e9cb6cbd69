#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "common/message/plant_truth.h"
#include "judge/metrics.h"
#include "judge/pause_probe.h"

namespace palp::judge {

/// Judges a simulated session by what is true in it, tick by tick: in the lab as it runs, and again
/// from its file, with the same answer to the last bit. Thread: any one.
class TruthJudge {
 public:
  /// Of every tick since the run began, also those of no script.
  void look(const PlantTruth& truth);

  /// Those in which the script was performed.
  [[nodiscard]] const std::vector<RunTick>& ticks() const noexcept { return ticks_; }
  [[nodiscard]] std::vector<RunTick> take_ticks() noexcept { return std::move(ticks_); }
  /// `force_cap` [N]: of the haptic device; `period` [s]: of a tick.
  [[nodiscard]] RunMetrics metrics(double force_cap, double period) const;

 private:
  /// [N], against 10 ticks ago, or the oldest since the force became the site's own.
  [[nodiscard]] double force_step(double force);

  std::vector<RunTick> ticks_;
  double work_min_{};  ///< [J]
  double net_min_{};   ///< [J]
  PauseProbe pauses_;
  std::deque<double> forces_;  ///< [N], newest last
  double step_max_{};          ///< [N]
  std::optional<Duration> dark_from_;
};

}  // namespace palp::judge
