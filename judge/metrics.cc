#include "judge/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>

#include "common/core/conventions.h"
#include "judge/felt_stiffness.h"

namespace palp::judge {
namespace {

constexpr double kUnstableSwing = 1.0 * kMillimetre;    ///< [m], in the second half of a hold
constexpr double kUnstableCapTime = 0.2;                ///< [s], at the force cap in total
constexpr double kUnstablePosition = 60 * kMillimetre;  ///< [m]
constexpr double kUnstableSpeed = 3.0;                  ///< [m/s]
constexpr double kFreeAirTail = 3.0;                    ///< [s]
constexpr std::size_t kStepTicks = 10;

/// Runs of ticks that belong to one phase.
std::vector<std::span<const RunTick>> split_phases(const std::vector<RunTick>& ticks) {
  std::vector<std::span<const RunTick>> phases;
  const auto key = [](const PhaseTag& tag) {
    return std::tuple{tag.kind, tag.place.x, tag.place.y, tag.index};
  };
  std::size_t begin = 0;
  for (std::size_t k = 1; k <= ticks.size(); ++k) {
    if (k < ticks.size() && key(ticks[k].phase) == key(ticks[begin].phase)) continue;
    if (ticks[begin].phase.kind != PhaseKind::Other) {
      phases.emplace_back(&ticks[begin], k - begin);
    }
    begin = k;
  }
  return phases;
}

void add(FeltStiffness& stiffness, std::span<const RunTick> tap) {
  for (const RunTick& tick : tap) {
    if (tick.counted)
      stiffness.add(tick.hand, tick.hand_velocity, tick.hand_force, tick.force_true);
  }
}

void judge_ratio(const FeltStiffness& a, const FeltStiffness& b, RunMetrics& metrics) {
  if (!a.error() || !b.error()) return;
  const double felt = *b.felt() / *a.felt();
  metrics.ratio_true = *b.truth() / *a.truth();
  metrics.ratio_error = felt / metrics.ratio_true - 1;
  metrics.contrast = (felt - 1) / (metrics.ratio_true - 1);
}

/// Means over the last 40 % of a press hold.
struct HoldMeans {
  double position{kUndefined};  ///< [m]
  double felt{kUndefined};      ///< [N]
  double truth{kUndefined};     ///< [N]
};

HoldMeans hold_means(std::span<const RunTick> hold) {
  HoldMeans means{0, 0, 0};
  double count = 0;
  for (const RunTick& tick : hold) {
    if (!tick.counted || tick.phase.elapsed < 0.6 * tick.phase.duration) continue;
    means.position += tick.hand;
    means.felt += tick.hand_force;
    means.truth += tick.force_true;
    ++count;
  }
  return {means.position / count, means.felt / count, means.truth / count};
}

struct Secants {
  double felt{kUndefined};   ///< [N/m]
  double truth{kUndefined};  ///< [N/m]
};

Secants secants(const HoldMeans& shallow, const HoldMeans& deep) {
  const double span = deep.position - shallow.position;
  return {(deep.felt - shallow.felt) / span, (deep.truth - shallow.truth) / span};
}

/// max - min of x_m in the second half of a hold [m].
double swing(std::span<const RunTick> hold) {
  double low = INFINITY;
  double high = -INFINITY;
  for (const RunTick& tick : hold) {
    if (!tick.counted || tick.phase.elapsed < 0.5 * tick.phase.duration) continue;
    low = std::min(low, tick.hand + tick.surface);
    high = std::max(high, tick.hand + tick.surface);
  }
  return high < low ? 0 : high - low;
}

void judge_stability(const std::vector<RunTick>& ticks,
                     std::span<const std::span<const RunTick>> phases,
                     const MetricsConfig& config,
                     RunMetrics& metrics) {
  for (const auto& phase : phases) {
    const PhaseKind kind = phase.front().phase.kind;
    if (kind != PhaseKind::PressHold && kind != PhaseKind::LiftHold) continue;
    if (swing(phase) >= kUnstableSwing) {
      metrics.unstable = true;
      metrics.unstable_reason = "the hand swings by 1 mm or more in a hold";
    }
  }
  double at_cap = 0;
  for (const RunTick& tick : ticks) {
    if (!tick.counted) continue;
    if (std::abs(tick.hand_force) >= config.force_cap * (1 - 1e-9)) at_cap += config.period;
    const bool runaway = !(std::abs(tick.hand) <= kUnstablePosition) ||
                         !(std::abs(tick.hand_velocity) <= kUnstableSpeed);
    if (runaway) {
      metrics.unstable = true;
      metrics.unstable_reason = "the hand ran away";
    }
  }
  if (at_cap >= kUnstableCapTime) {
    metrics.unstable = true;
    metrics.unstable_reason = "the force stayed at the device's limit for 0.2 s";
  }
}

constexpr double kContactForce = 0.1;                 ///< [N], two steps of the transducer
constexpr double kLearningDepth = 1.0 * kMillimetre;  ///< [m]
constexpr double kLearningForce = 0.02;               ///< [N]
constexpr double kLearningShare = 0.1;                ///< [-]
constexpr double kLearningTime = 0.05;                ///< [s], of right force

/// How long the force at a new site is wrong.
double learning_time(const std::vector<RunTick>& ticks, Site site, double period) {
  double began_at = kUndefined;
  double right_for = 0;
  for (const RunTick& tick : ticks) {
    const bool here = tick.phase.site == site && tick.phase.kind != PhaseKind::FreeAir;
    if (!here || !tick.counted) continue;
    if (std::isnan(began_at) && tick.contact_force >= kContactForce) began_at = tick.at;
    if (std::isnan(began_at) || tick.hand <= kLearningDepth) continue;
    const double allowed = std::max(kLearningForce, kLearningShare * tick.force_true);
    right_for = std::abs(tick.hand_force - tick.force_true) <= allowed ? right_for + period : 0;
    if (right_for >= kLearningTime) return tick.at - began_at;
  }
  return kUndefined;
}

/// rms of felt - true over all ticks of all taps.
double tap_force_rms(std::span<const std::span<const RunTick>> phases) {
  double square = 0;
  double count = 0;
  for (const auto& phase : phases) {
    if (phase.front().phase.kind != PhaseKind::Tap) continue;
    for (const RunTick& tick : phase) {
      if (!tick.counted) continue;
      square += (tick.hand_force - tick.force_true) * (tick.hand_force - tick.force_true);
      ++count;
    }
  }
  return std::sqrt(square / count);
}

constexpr double kInTheAir = -1.5 * kMillimetre;  ///< [m]

void judge_blackout(const std::vector<RunTick>& ticks,
                    const MetricsConfig& config,
                    RunMetrics& metrics) {
  if (config.blackout_to <= config.blackout_from) return;
  metrics.phantom_force = 0;
  metrics.stage_speed_max = 0;
  for (const RunTick& tick : ticks) {
    if (tick.at < config.blackout_from || tick.at > config.blackout_to) continue;
    if (tick.hand < kInTheAir) {
      metrics.phantom_force = std::max(metrics.phantom_force, std::abs(tick.hand_force));
    }
    metrics.stage_speed_max = std::max(metrics.stage_speed_max, std::abs(tick.tip_velocity));
  }
}

void judge_taps(std::span<const std::span<const RunTick>> phases, RunMetrics& metrics) {
  std::array<FeltStiffness, 2> pooled;
  for (const auto& phase : phases) {
    const PhaseTag& tag = phase.front().phase;
    if (tag.kind != PhaseKind::Tap) continue;
    const auto site = static_cast<std::size_t>(tag.site);
    FeltStiffness own;
    add(own, phase);
    double deepest = -INFINITY;
    for (const RunTick& tick : phase) deepest = std::max(deepest, tick.hand);
    metrics.taps.push_back({.site = tag.site,
                            .place = tag.place,
                            .index = tag.index,
                            .began_at = phase.front().at,
                            .ended_at = phase.back().at,
                            .hand_max = deepest,
                            .stiffness = own});
    if (tag.site == Site::Other) continue;
    if (tag.index == 1) metrics.tap1_error[site] = own.error().value_or(kUndefined);
    if (tag.index == 2) metrics.tap2_error[site] = own.error().value_or(kUndefined);
    if (tag.index >= 2) add(pooled[site], phase);
  }
  metrics.tap_error[0] = pooled[0].error().value_or(kUndefined);
  metrics.tap_error[1] = pooled[1].error().value_or(kUndefined);
  judge_ratio(pooled[0], pooled[1], metrics);
}

void judge_holds(std::span<const std::span<const RunTick>> phases, RunMetrics& metrics) {
  std::array<std::array<HoldMeans, 2>, 2> holds;
  for (const auto& phase : phases) {
    const PhaseTag& tag = phase.front().phase;
    if (tag.site == Site::Other) continue;
    if (tag.kind == PhaseKind::PressHold && (tag.index == 1 || tag.index == 2)) {
      holds[static_cast<std::size_t>(tag.site)][static_cast<std::size_t>(tag.index - 1)] =
          hold_means(phase);
    }
    if (tag.kind == PhaseKind::LiftHold && tag.site == Site::B) {
      double sum = 0;
      double count = 0;
      for (const RunTick& tick : phase) {
        if (!tick.counted || tick.phase.elapsed < 0.8 * tick.phase.duration) continue;
        sum += std::abs(tick.tip - tick.hand);
        ++count;
      }
      metrics.drift = sum / count;
    }
  }
  const Secants a = secants(holds[0][0], holds[0][1]);
  const Secants b = secants(holds[1][0], holds[1][1]);
  metrics.static_error[0] = a.felt / a.truth - 1;
  metrics.static_error[1] = b.felt / b.truth - 1;
  metrics.static_ratio_error = b.felt / a.felt / (b.truth / a.truth) - 1;
}

void judge_forces(const std::vector<RunTick>& ticks,
                  const MetricsConfig& config,
                  RunMetrics& metrics) {
  double square = 0;
  double count = 0;
  double peak = 0;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const RunTick& tick = ticks[k];
    metrics.force_peak = std::max(metrics.force_peak, std::abs(tick.hand_force));
    metrics.contact_force_max = std::max(metrics.contact_force_max, tick.contact_force);
    // Across a break of the session there is no step.
    const bool whole =
        k >= kStepTicks && tick.at - ticks[k - kStepTicks].at < (kStepTicks + 0.5) * config.period;
    if (whole) {
      const RunTick& before = ticks[k - kStepTicks];
      const double step = tick.hand_force - before.hand_force;
      const double unexplained = step - (tick.force_true - before.force_true);
      metrics.force_step_10ms = std::max(metrics.force_step_10ms, std::abs(step));
      metrics.force_step_event =
          std::max(metrics.force_step_event, std::min(std::abs(step), std::abs(unexplained)));
    }
    const bool in_air = tick.counted && tick.phase.kind == PhaseKind::FreeAir &&
                        tick.phase.elapsed >= tick.phase.duration - kFreeAirTail;
    if (in_air) {
      square += tick.hand_force * tick.hand_force;
      peak = std::max(peak, std::abs(tick.hand_force));
      ++count;
    }
  }
  if (count > 0) {
    metrics.drag_rms = std::sqrt(square / count);
    metrics.drag_peak = peak;
  }
  if (!ticks.empty()) {
    metrics.energy_operator = std::max(0.0, -ticks.back().energy_operator_min);
    metrics.energy_net = std::max(0.0, -ticks.back().energy_net_min);
  }
}

}  // namespace

RunMetrics metrics_of(const std::vector<RunTick>& ticks, const MetricsConfig& config) {
  RunMetrics metrics;
  if (ticks.empty()) return metrics;
  const auto phases = split_phases(ticks);
  judge_stability(ticks, phases, config, metrics);
  judge_taps(phases, metrics);
  judge_holds(phases, metrics);
  judge_forces(ticks, config, metrics);
  judge_blackout(ticks, config, metrics);
  metrics.force_rms = tap_force_rms(phases);
  metrics.learning[0] = learning_time(ticks, Site::A, config.period);
  metrics.learning[1] = learning_time(ticks, Site::B, config.period);
  return metrics;
}

}  // namespace palp::judge
