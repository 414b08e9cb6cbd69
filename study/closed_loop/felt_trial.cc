#include "study/closed_loop/felt_trial.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lab/plan/scenario_file.h"
#include "lab/run/direct_touch.h"
#include "lab/run/run.h"
#include "study/closed_loop/drawn_taps.h"
#include "study/closed_loop/felt_lag.h"
#include "study/closed_loop/felt_slopes.h"
#include "study/trial.h"
#include "surgeon_site/script_builder.h"

namespace palp::study {
namespace {

using std::chrono::milliseconds;

constexpr Duration kTap = milliseconds{1000};
constexpr Duration kPause = milliseconds{500};
constexpr Duration kDown = milliseconds{500};
constexpr Duration kStride = milliseconds{400};  // to the next place of a search
constexpr Duration kChange = milliseconds{100};  // of a link, after the hand has left the tissue
constexpr Duration kRamp = milliseconds{1000};   // of such a change
constexpr double kContact = 50e-3;               // [N], of the tip

/// The scenario's own words for a condition.
Result<lab::Scenario> scenario_of(const Condition& condition) {
  auto document = lab::load_scenario("standard");
  if (!document) return tl::unexpected(document.error());
  const std::string text = "up {" + condition.up + "} down {" + condition.down +
                           "} surgeon { coupling { name: \"" + condition.coupling +
                           "\" } hand { grip: \"" + condition.grip +
                           "\" } } patient { coupling { name: \"" + condition.coupling +
                           "\" } simulated_phantom { phantom: \"none\" } }";
  const std::string name = "condition " + condition.name;
  if (auto merged = document->merge(text, name); !merged) return tl::unexpected(merged.error());
  if (auto checked = document->check(); !checked) return fail(name, checked.error());
  auto scenario = lab::make_scenario(name, *document);
  if (!scenario) return fail(name, scenario.error());
  scenario->bare = true;
  scenario->depths = condition.feedback == Feedback::Depth;
  if (!gives_force(condition.feedback)) scenario->surgeon.gate.force_max = 0;
  return scenario;
}

/// A, B, and on as far apart, where the setting says nothing else.
Place place_of(const FeltSetting& setting, std::size_t interval) noexcept {
  const bool said = interval < setting.places.size() && setting.places[interval].at;
  return said ? *setting.places[interval].at
              : between(kSiteA, kSiteB, static_cast<double>(interval));
}

bool delayed(const FeltSetting& setting) noexcept {
  return std::ranges::any_of(setting.places, [](const FeltPlace& one) { return one.delay > 0; });
}

/// Who searches goes from one place to the next on the shortest way.
TrialTimes times_of(const FeltSetting& setting) noexcept {
  TrialTimes times;
  if (setting.hidden) times.travel = kStride;
  return times;
}

/// Of each interval's travel, in the script.
Duration travel_of(const FeltSetting& setting) noexcept {
  return times_of(setting).travel + milliseconds{50};
}

/// The way down as it is to be in each interval, from the beginning of its travel. `begin`: of the
/// script.
std::vector<netem::Change> delays_of(const FeltSetting& setting,
                                     const netem::Impairment& down,
                                     Duration begin) {
  std::vector<netem::Change> changes;
  Duration at = begin;
  double before = 0;
  for (const FeltPlace& place : setting.places) {
    if (place.delay != before) {
      netem::Impairment delayed = down;
      delayed.delay.mean += from_seconds(place.delay / 1e3);
      // Evenly: a step would be a gap in what arrives.
      changes.push_back({.at = at + kChange,
                         .kind = netem::Change::Kind::Ramp,
                         .impairment = delayed,
                         .span = kRamp});
      before = place.delay;
    }
    at += travel_of(setting) + static_cast<int>(place.depth.size()) * (kTap + kPause);
    if (&place == &setting.places.front()) at += kDown;
  }
  return changes;
}

surgeon::GestureScript script_of(const FeltSetting& setting, double hand_stiffness) {
  surgeon::ScriptBuilder script{hand_stiffness};
  for (std::size_t interval = 0; interval < setting.places.size(); ++interval) {
    script.site(place_of(setting, interval)).hold(travel_of(setting));
    if (interval == 0) script.move(surgeon::kNearPlace, kDown);
    for (const double depth : setting.places[interval].depth) script.taps(1, depth, kTap, kPause);
  }
  return script.hold(milliseconds{200}).build();
}

/// When in a run the hand is engaged and goes by its script, whatever that is.
Duration script_begin(lab::Scenario scenario) {
  surgeon::ScriptBuilder script{scenario.hand.plant.grip.stiffness};
  scenario.script = script.hold(milliseconds{10}).build();
  const lab::RunResult result = lab::simulate(scenario);
  return result.ticks.empty() ? Duration{} : from_seconds(result.ticks.front().at);
}

/// What is shown of each place is the estimator's last answer there that is one.
void tell_depths(const std::vector<DepthEstimate>& estimates,
                 const FeltSetting& setting,
                 FeltTrial& felt) {
  for (std::size_t i = 0; i < felt.intervals.size(); ++i) {
    std::optional<double>& depth = felt.intervals[i].ball_depth;
    for (const DepthEstimate& one : estimates) {
      if (distance(one.place, place_of(setting, i)) > kSamePlace) continue;
      if (one.verdict == DepthVerdict::Found) depth = one.depth;
      if (one.verdict == DepthVerdict::None) depth.reset();
    }
  }
}

/// Goes through a Trial with what a hand meets, and keeps what it felt.
class Listener {
 public:
  /// `step` [N] of forces that are drawn. `unjudged`: taps of each interval after which the force
  /// is watched for a lag, where there may be one.
  Listener(const FeltSetting& setting, int taps, int unjudged, double step)
      : trial_{setting.places.size(), taps, false, times_of(setting)},
        slopes_(setting.places.size()),
        drawn_(setting.places.size(), DrawnTaps{step}),
        lags_(delayed(setting) ? setting.places.size() : 0),
        unjudged_{unjudged} {}

  /// `force` [N] at the hand, `tip_force` [N] at the tip.
  void tick(TimePoint now, double position, double force, double tip_force) {
    now_ = now;
    // A touch ends an interval, and is seen to its end.
    if (trial_.stage() == TrialStage::Explore) drawn_[trial_.interval()].see(position, tip_force);
    trial_.tick(now, {.force = force, .contact = tip_force > kContact});
    if (trial_.stage() == TrialStage::Explore) {
      slopes_[trial_.interval()].feel(position, force);
      const bool watched = !lags_.empty() && trial_.taps_of_interval() >= unjudged_;
      if (watched) lags_[trial_.interval()].feel(position, force);
    }
    if (tip_force > kContact) {
      touched_ += tip_force;
      ++touching_;
    }
    if (trial_.stage() == TrialStage::Answer && asked_ == 0) asked_ = seconds(trial_.length(now));
  }
  [[nodiscard]] FeltTrial heard() const {
    std::vector<FeltInterval> intervals;
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      intervals.push_back(
          {.ln_slopes = slopes_[i].ln_slopes(), .ln_drawn = drawn_[i].ln_stiffness()});
      if (!lags_.empty()) intervals.back().lag = lags_[i].lag();
    }
    return {.intervals = std::move(intervals),
            .duration = asked_ > 0 ? asked_ : seconds(trial_.length(now_)),
            .taps = trial_.taps(),
            .force_max = trial_.force_max(),
            .contact = seconds(trial_.contact()),
            .force_mean = touching_ > 0 ? touched_ / touching_ : 0};
  }

 private:
  Trial trial_;
  std::vector<FeltSlopes> slopes_;  ///< of each interval
  std::vector<DrawnTaps> drawn_;    ///< likewise
  std::vector<FeltLag> lags_;       ///< likewise; none: no interval is delayed
  int unjudged_;
  double touched_{};  ///< [N], sum over the ticks that the tip touched
  int touching_{};    ///< those
  TimePoint now_{};
  double asked_{};  ///< [s]
};

}  // namespace

struct FeltSession::Parts {
  lab::Scenario scenario;
  LevelCurves curves;
  LevelCurves plain{};

  /// `resisted`: the hand is given a force, and aims the deeper.
  [[nodiscard]] lab::Scenario with(const FeltSetting& setting, bool resisted) const {
    lab::Scenario out = scenario;
    out.seed = setting.seed;
    out.script = script_of(
        setting,
        resisted ? scenario.hand.plant.grip.stiffness : std::numeric_limits<double>::infinity());
    if (setting.hidden) {
      out.phantom = curves.hiding(setting.hidden->level, setting.hidden->axis);
      return out;
    }
    // A tissue is known at two places at least: where one is touched, plain tissue lies beside it.
    for (std::size_t i = 0; i < std::max<std::size_t>(2, setting.places.size()); ++i) {
      const double above = i < setting.places.size() ? setting.places[i].ln_stiffness : 0;
      const LevelCurves& of = setting.plain ? plain : curves;
      out.phantom.survey.push_back({place_of(setting, i), of.at(above)});
    }
    return out;
  }
};

FeltSession::FeltSession(std::unique_ptr<Parts> parts, const Condition& condition) noexcept
    : parts_{std::move(parts)},
      feedback_{condition.feedback},
      taps_{condition.taps},
      unjudged_{condition.unjudged} {}
FeltSession::FeltSession(FeltSession&& other) noexcept = default;
FeltSession& FeltSession::operator=(FeltSession&& other) noexcept = default;
FeltSession::~FeltSession() = default;

Result<FeltSession> FeltSession::make(const Condition& condition, const LevelCurves& curves) {
  auto scenario = scenario_of(condition);
  if (!scenario) return tl::unexpected(scenario.error());
  return FeltSession{std::make_unique<Parts>(Parts{std::move(*scenario), curves}), condition};
}

double FeltSession::place_time(int taps) noexcept {
  return seconds(kStride + milliseconds{50} + taps * (kTap + kPause));
}

FeltTrial FeltSession::judged_of(FeltTrial felt) const {
  for (FeltInterval& interval : felt.intervals) {
    for (std::vector<double>* taps : {&interval.ln_slopes, &interval.ln_drawn}) {
      const auto first = std::min(taps->size(), static_cast<std::size_t>(unjudged_));
      taps->erase(taps->begin(), taps->begin() + static_cast<std::ptrdiff_t>(first));
    }
  }
  return felt;
}

FeltTrial FeltSession::feel(const FeltSetting& setting) const {
  lab::Scenario scenario = parts_->with(setting, gives_force(feedback_));
  if (delayed(setting)) {
    scenario.down_changes = delays_of(setting, scenario.down, script_begin(scenario));
  }
  const lab::RunResult result = lab::simulate(scenario);
  Listener listener{setting, taps_, unjudged_, parts_->scenario.tissue.force_quantum};
  for (const judge::RunTick& tick : result.ticks) {
    const TimePoint at = TimePoint{} + from_seconds(tick.at);
    listener.tick(at, tick.hand, tick.hand_force, tick.contact_force);
  }
  FeltTrial felt = judged_of(listener.heard());
  tell_depths(result.depths, setting, felt);
  return felt;
}

FeltTrial FeltSession::touch(const FeltSetting& setting) const {
  Listener listener{setting, taps_, unjudged_, 0};
  for (const lab::TouchTick& tick : lab::direct_touch(parts_->with(setting, true))) {
    listener.tick(TimePoint{} + tick.at, tick.position, tick.force, tick.force);
  }
  return judged_of(listener.heard());
}

}  // namespace palp::study
