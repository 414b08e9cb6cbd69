#include "review/session_metrics.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "common/config/document.h"
#include "judge/metric_table.h"
#include "judge/truth_judge.h"
#include "review/phase_finder.h"
#include "surgeon_site/script_reader.h"
#include "surgeon_site/settings.h"

namespace palp::review {
namespace {

std::optional<surgeon::Settings> settings_of(const SiteData& surgeon) {
  if (!surgeon.settings) return std::nullopt;
  config::Document document = config::surgeon_document();
  if (!document.merge(*surgeon.settings, "config.textproto")) return std::nullopt;
  auto settings = surgeon::make_settings(document);
  return settings ? std::optional{std::move(*settings)} : std::nullopt;
}

/// The script that the surgeon's settings name; nothing: there is none, or it cannot be had.
std::optional<surgeon::GestureScript> script_of(const SiteData& surgeon) {
  const auto settings = settings_of(surgeon);
  if (!settings || settings->master.starts_with("replay:")) return std::nullopt;
  const double round_trip = surgeon.number("script_round_trip_s").value_or(0);
  auto script =
      surgeon::load_script(settings->master,
                           {.hand_stiffness = settings->hand.plant.grip.stiffness,
                            .round_trip = from_seconds(std::clamp(round_trip, 0.0, 60.0))});
  return script ? std::optional{std::move(*script)} : std::nullopt;
}

/// Where in its script the hand was: by the phases that it told, each from its beginning on. What
/// comes after a break within a phase is nobody's, until the next phase begins.
class ScriptFollower {
 public:
  explicit ScriptFollower(const SiteData& surgeon)
      : script_{script_of(surgeon)}, changes_{surgeon.phases} {
    if (script_) finder_.emplace(*script_);
  }
  ScriptFollower(const ScriptFollower&) = delete;
  ScriptFollower& operator=(const ScriptFollower&) = delete;

  [[nodiscard]] bool knows() const { return script_.has_value() && !changes_.empty(); }
  judge::PhaseTag at(TimePoint now, bool counted) {
    while (next_ < changes_.size() && changes_[next_].at <= now) {
      present_ = changes_[next_++];
      broken_ = false;
    }
    broken_ = broken_ || !counted;
    const bool within = present_.phase > 0 && knows() && present_.phase <= script_->phases().size();
    if (!within || broken_) return {};
    const Duration time = script_->phase(present_.phase).began_at + elapsed(present_.at, now);
    return time < script_->length() ? finder_->at(time) : judge::PhaseTag{};
  }

 private:
  std::optional<surgeon::GestureScript> script_;
  std::optional<PhaseFinder> finder_;
  const std::vector<PhaseChange>& changes_;
  std::size_t next_{};
  PhaseChange present_;
  bool broken_{};
};

/// The patient's motion beside the surgeon's: the newest of each instant.
class TipFollower {
 public:
  explicit TipFollower(const SessionPair& session)
      : motion_{session.patient.motion}, line_{session.time_line} {}
  /// nullptr: none yet.
  const judge::Motion* at(TimePoint now) {
    while (next_ < motion_.size() && line_.surgeons(motion_[next_].at) <= now) ++next_;
    return next_ == 0 ? nullptr : &motion_[next_ - 1];
  }

 private:
  const std::vector<judge::Motion>& motion_;
  const TimeLine& line_;
  std::size_t next_{};
};

/// Work of the hand on its device, and of the tip on the tissue.
class WorkAccount {
 public:
  void add(const judge::Motion& hand, const judge::Motion* tip, double period) {
    hand_ += hand.force * hand.velocity * period;
    if (tip != nullptr) tissue_ += tip->force * tip->velocity * period;
    hand_min_ = std::min(hand_min_, hand_);
    net_min_ = std::min(net_min_, hand_ - tissue_);
  }
  void tell(judge::RunTick& tick) const {
    tick.energy_operator = hand_;
    tick.energy_operator_min = hand_min_;
    tick.energy_net_min = net_min_;
  }

 private:
  double hand_{};      ///< [J]
  double tissue_{};    ///< [J]
  double hand_min_{};  ///< [J]
  double net_min_{};   ///< [J]
};

/// [N] of the tissue's law `indentation` [m] past its surface; above it there is none.
double truth_of(const judge::TissueTable* tissue, const Place& place, double indentation) {
  if (tissue == nullptr) return judge::kUndefined;
  if (indentation <= 0) return 0;
  return tissue->force(place, indentation).value_or(judge::kUndefined);
}

constexpr double kPeriod = 1e-3;  ///< [s], of a tick

/// Of a session of the lab, from what it wrote down of the true states.
SessionTicks true_ticks(const SiteData& surgeon) {
  judge::TruthJudge judge;
  for (const PlantTruth& truth : surgeon.truths) judge.look(truth);
  const auto settings = settings_of(surgeon);
  const judge::MetricsConfig usual;
  SessionTicks made;
  made.phases = true;
  made.of_truth = settings ? judge.metrics(settings->hand.force_max, seconds(settings->link.period))
                           : judge.metrics(usual.force_cap, usual.period);
  made.ticks = judge.take_ticks();
  const PlantTruth& first = surgeon.truths.front();
  made.run_began = first.at - first.run_time;
  return made;
}

}  // namespace

SessionTicks session_ticks(const SessionPair& session, const judge::TissueTable* tissue) {
  const SiteData& surgeon = session.surgeon;
  if (!surgeon.truths.empty()) return true_ticks(surgeon);
  SessionTicks made;
  const double surface = session.patient.number("surface_offset_mm").value_or(0) * 1e-3;
  ScriptFollower script{surgeon};
  TipFollower tips{session};
  WorkAccount work;
  made.phases = script.knows();
  made.ticks.reserve(surgeon.motion.size());
  for (std::size_t i = 0; i < surgeon.motion.size(); ++i) {
    const judge::Motion& hand = surgeon.motion[i];
    const judge::Motion* const tip = tips.at(hand.at);
    const bool counted =
        surgeon.states[i] == SiteState::Engaged || surgeon.states[i] == SiteState::Hold;
    work.add(hand, tip, kPeriod);
    judge::RunTick tick;
    tick.at = seconds(elapsed(surgeon.began_at, hand.at));
    tick.phase = script.at(hand.at, counted);
    tick.counted = counted;
    tick.hand = hand.position - surface;
    tick.hand_velocity = hand.velocity;
    tick.hand_force = hand.force;
    tick.force_true = truth_of(tissue, hand.place, tick.hand);
    tick.tip = judge::kUndefined;
    if (tip != nullptr) {
      tick.contact_force = tip->force;
      tick.tip = tip->position - surface;
      tick.tip_velocity = tip->velocity;
      tick.tip_place = tip->place;
    }
    work.tell(tick);
    made.ticks.push_back(tick);
  }
  return made;
}

judge::RunMetrics session_metrics(const SessionTicks& session) {
  if (session.of_truth) return *session.of_truth;
  judge::RunMetrics metrics = judge::metrics_of(session.ticks, {});
  // Whoever knows when a process stood still says these.
  metrics.whole = {.force_step = judge::kUndefined,
                   .force_kick = judge::kUndefined,
                   .force_drop = judge::kUndefined,
                   .energy_given = judge::kUndefined};
  return metrics;
}

config::Json metrics_json(const SessionTicks& session) {
  const judge::RunMetrics metrics = session_metrics(session);
  config::Json json;
  json["phases_known"] = session.phases;
  json["by_true_states"] = session.of_truth.has_value();
  json["unstable"] = metrics.unstable;
  json["unstable_reason"] = metrics.unstable_reason;
  for (const judge::Metric& metric : judge::metric_table()) {
    const double value = metric.value(metrics);
    json[metric.name] = std::isfinite(value) ? config::Json(value) : config::Json(nullptr);
  }
  return json;
}

}  // namespace palp::review
