#include "review/session_metrics.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "common/config/document.h"
#include "judge/metric_table.h"
#include "judge/port_work.h"
#include "judge/run_judge.h"
#include "judge/truth_judge.h"
#include "patient_site/phantom.h"
#include "review/phase_finder.h"
#include "review/tick_source.h"
#include "surgeon_site/script_reader.h"
#include "surgeon_site/script_source.h"
#include "surgeon_site/settings.h"

namespace palp::review {
namespace {

std::optional<surgeon::Settings> settings_of(const SiteData& surgeon) {
  if (!surgeon.texts.settings) return std::nullopt;
  config::Document document = config::surgeon_document();
  if (!document.merge(*surgeon.texts.settings, "config.textproto")) return std::nullopt;
  auto settings = surgeon::make_settings(document);
  return settings ? std::optional{std::move(*settings)} : std::nullopt;
}

/// The script that was played. A file's text is in the recording: what lies at that path today is
/// another. Nothing: there is none, or it was not recorded.
std::optional<surgeon::GestureScript> script_of(const SiteData& surgeon) {
  const auto settings = settings_of(surgeon);
  if (!settings) return std::nullopt;
  if (surgeon.texts.script) {
    auto recorded =
        surgeon::parse_script(*surgeon.texts.script, settings->hand.plant.grip.stiffness);
    return recorded ? std::optional{std::move(*recorded)} : std::nullopt;
  }
  if (!surgeon::is_ready_made(settings->master)) return std::nullopt;
  const double round_trip = surgeon.number("script_round_trip_s").value_or(0);
  auto script =
      surgeon::load_script(settings->master,
                           {.hand_stiffness = settings->hand.plant.grip.stiffness,
                            .round_trip = from_seconds(std::clamp(round_trip, 0.0, 60.0))});
  return script ? std::optional{std::move(*script)} : std::nullopt;
}

/// Where in its script the hand was: by the phases that it told, each from its beginning on. What
/// comes after a break within a phase is nobody's, until the next phase begins. Of a hand without a
/// script only the site that it is at is known.
class ScriptFollower {
 public:
  explicit ScriptFollower(const SiteData& surgeon)
      : script_{script_of(surgeon)}, changes_{surgeon.phases} {
    if (script_) finder_.emplace(*script_);
  }
  ScriptFollower(const ScriptFollower&) = delete;
  ScriptFollower& operator=(const ScriptFollower&) = delete;

  [[nodiscard]] bool knows() const { return script_.has_value() && !changes_.empty(); }
  judge::PhaseTag at(TimePoint now, bool counted, const Place& hand) {
    while (next_ < changes_.size() && changes_[next_].at <= now) {
      present_ = changes_[next_++];
      broken_ = false;
    }
    broken_ = broken_ || !counted;
    if (!knows()) {
      judge::PhaseTag here;
      here.site = site_at(hand);
      return here;
    }
    const bool within = present_.phase > 0 && present_.phase <= script_->phases().size();
    if (!within || broken_) return {};
    const Duration time = script_->phase(present_.phase).began_at + elapsed(present_.at, now);
    return time < script_->length() ? finder_->at(time, hand) : judge::PhaseTag{};
  }

 private:
  std::optional<surgeon::GestureScript> script_;
  std::optional<PhaseFinder> finder_;
  const std::vector<PhaseChange>& changes_;
  std::size_t next_{};
  PhaseChange present_;
  bool broken_{};
};

judge::Motion motion_of(const SiteTick& tick) {
  return {.at = tick.at,
          .position = tick.position,
          .velocity = tick.velocity,
          .force = tick.force,
          .place = tick.place};
}

/// The patient's motion beside the surgeon's: the newest of each instant.
class TipFollower {
 public:
  explicit TipFollower(const SessionPair& session)
      : ticks_{session.patient}, line_{session.time_line}, next_{ticks_.next_tick()} {}
  /// nullptr: none yet.
  const judge::Motion* at(TimePoint now) {
    while (next_ && line_.surgeons(next_->at) <= now) {
      present_ = motion_of(*next_);
      next_ = ticks_.next_tick();
    }
    return present_ ? &*present_ : nullptr;
  }

 private:
  TickSource ticks_;
  const TimeLine& line_;
  std::optional<SiteTick> next_;
  std::optional<judge::Motion> present_;
};

/// Work of the hand on its device, and of the tip on the tissue.
class WorkAccount {
 public:
  void add(const judge::Motion& hand, const judge::Motion* tip) {
    hand_.add_applied(hand.position, hand.force);
    if (tip != nullptr) tissue_.add_reading(tip->position, tip->force);
    hand_min_ = std::min(hand_min_, hand_.work());
    net_min_ = std::min(net_min_, hand_.work() - tissue_.work());
  }
  void tell(judge::RunTick& tick) const {
    tick.energy_operator = hand_.work();
    tick.energy_operator_min = hand_min_;
    tick.energy_net_min = net_min_;
  }

 private:
  judge::PortWork hand_;
  judge::PortWork tissue_;
  double hand_min_{};  ///< [J]
  double net_min_{};   ///< [J]
};

/// [N] of the tissue's law `indentation` [m] past its surface; above it there is none.
double truth_of(const judge::TissueTable* tissue, const Place& place, double indentation) {
  if (tissue == nullptr) return judge::kUndefined;
  if (indentation <= 0) return 0;
  return tissue->force(place, indentation).value_or(judge::kUndefined);
}

/// Takes a session's ticks as both sites wrote them down, and judges them.
class LoggedJudge {
 public:
  LoggedJudge(const SessionPair& session, const judge::TissueTable* tissue)
      : began_at_{session.surgeon.began_at},
        surface_{session.patient.number("surface_offset_mm").value_or(0) * 1e-3},
        tissue_{tissue},
        script_{session.surgeon},
        tips_{session} {}

  judge::RunTick look(const SiteTick& hand) {
    const judge::Motion* const tip = tips_.at(hand.at);
    const bool counted = hand.state == SiteState::Engaged || hand.state == SiteState::Hold;
    work_.add(motion_of(hand), tip);
    judge::RunTick tick;
    tick.at = seconds(elapsed(began_at_, hand.at));
    tick.phase = script_.at(hand.at, counted, hand.place);
    tick.counted = counted;
    tick.hand = hand.position - surface_;
    tick.hand_velocity = hand.velocity;
    tick.hand_force = hand.force;
    tick.force_true = truth_of(tissue_, hand.place, tick.hand);
    tick.told_short = hand.short_note != 0;
    tick.tip = judge::kUndefined;
    if (tip != nullptr) {
      tick.contact_force = tip->force;
      tick.tip = tip->position - surface_;
      tick.tip_velocity = tip->velocity;
      tick.tip_place = tip->place;
    }
    work_.tell(tick);
    judge_.look(tick);
    return tick;
  }
  [[nodiscard]] bool phases() const { return script_.knows(); }
  [[nodiscard]] judge::RunMetrics metrics() const {
    judge::RunMetrics metrics = judge_.metrics();
    // Whoever knows when a process stood still says these.
    metrics.whole = {.force_step = judge::kUndefined,
                     .force_kick = judge::kUndefined,
                     .force_drop = judge::kUndefined,
                     .force_unexplained = judge::kUndefined,
                     .energy_given = judge::kUndefined};
    return metrics;
  }

 private:
  TimePoint began_at_;
  double surface_;  ///< [m]
  const judge::TissueTable* tissue_;
  ScriptFollower script_;
  TipFollower tips_;
  WorkAccount work_;
  judge::RunJudge judge_{judge::MetricsConfig{}};
};

judge::MetricsConfig config_of(const SiteData& surgeon) {
  judge::MetricsConfig config;
  // That of the lab's path is known; that of a network is measured.
  const double measured = surgeon.last_link ? seconds(surgeon.last_link->health.round_trip) : 0;
  config.round_trip = surgeon.number("script_round_trip_s").value_or(measured);
  if (const auto settings = settings_of(surgeon)) {
    config.force_cap = settings->hand.force_max;
    config.period = seconds(settings->link.period);
  }
  return config;
}

/// A tissue in words is known everywhere: its curves where it was touched.
void add_touched_places(const SiteData& patient, judge::TissueTable& table) {
  if (!patient.texts.tissue_words) return;
  const auto phantom = patient::make_phantom(*patient.texts.tissue_words);
  if (!phantom || !phantom->block) return;
  const auto field = patient::make_field(*phantom, 0);
  constexpr double kStep = 20e-6;  // [m], as in tissue.csv
  const int count = static_cast<int>(phantom->depth_max() / kStep + 1e-6);
  for (const DepthEstimate& estimate : patient.estimates) {
    std::vector<judge::TissueTable::Row> rows;
    for (int i = 0; i <= count; ++i) {
      rows.push_back({i * kStep, field->elastic_force(estimate.place, i * kStep)});
    }
    table.add(estimate.place, std::move(rows));
  }
}

}  // namespace

Result<std::optional<judge::TissueTable>> tissue_of(const SiteData& patient,
                                                    const std::string& path) {
  if (!patient.texts.tissue_csv) return std::optional<judge::TissueTable>{};
  auto table = judge::TissueTable::parse(*patient.texts.tissue_csv);
  if (!table) return fail(path, table.error());
  add_touched_places(patient, *table);
  return std::optional{std::move(*table)};
}

JudgedSession judge_session(const SessionPair& session,
                            const judge::TissueTable* tissue,
                            TickWatcher* watcher) {
  JudgedSession made;
  const SiteData& surgeon = session.surgeon;
  made.by_truth = surgeon.run_began.has_value();
  made.run_began = surgeon.run_began.value_or(TimePoint{});
  judge::ExcursionFinder strokes{surface_of(session.patient), tissue};
  const auto keep = [&](const std::optional<judge::Excursion>& stroke) {
    if (stroke && made.excursions.size() < kListMax) made.excursions.push_back(*stroke);
  };
  const auto show = [&](const std::optional<judge::RunTick>& tick) {
    if (tick && watcher != nullptr) watcher->see(*tick);
  };
  std::optional<judge::TruthJudge> truth;
  std::optional<LoggedJudge> logged;
  if (made.by_truth) {
    truth.emplace(config_of(surgeon));
  } else {
    logged.emplace(session, tissue);
  }
  TickSource source{surgeon};
  bool told_short = false;  // by the newest tick
  while (const auto item = source.next()) {
    if (const auto* state = std::get_if<PlantTruth>(&*item)) {
      if (truth) show(truth->look(*state, told_short));
      continue;
    }
    const SiteTick& tick = std::get<SiteTick>(*item);
    told_short = tick.short_note != 0;
    keep(strokes.look(motion_of(tick)));
    if (logged) show(logged->look(tick));
  }
  keep(strokes.finish());
  made.phases = truth || logged->phases();
  made.metrics = truth ? truth->metrics() : logged->metrics();
  return made;
}

config::Json metrics_json(const JudgedSession& session) {
  const judge::RunMetrics& metrics = session.metrics;
  config::Json json;
  json["phases_known"] = session.phases;
  json["by_true_states"] = session.by_truth;
  json["unstable"] = metrics.unstable;
  json["unstable_reason"] = metrics.unstable_reason;
  for (const judge::Metric& metric : judge::metric_table()) {
    const double value = metric.value(metrics);
    json[metric.name] = std::isfinite(value) ? config::Json(value) : config::Json(nullptr);
  }
  return json;
}

}  // namespace palp::review
