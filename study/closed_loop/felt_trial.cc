#include "study/closed_loop/felt_trial.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lab/plan/scenario_file.h"
#include "lab/run/direct_touch.h"
#include "lab/run/run.h"
#include "study/closed_loop/drawn_taps.h"
#include "study/closed_loop/felt_slopes.h"
#include "study/trial.h"
#include "surgeon_site/script_builder.h"

namespace palp::study {
namespace {

using std::chrono::milliseconds;

constexpr Duration kTap = milliseconds{1000};
constexpr Duration kPause = milliseconds{500};
constexpr Duration kDown = milliseconds{500};
constexpr double kContact = 50e-3;  // [N], of the tip

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

/// A, B, and on as far apart.
Place place_of(std::size_t interval) noexcept {
  return between(kSiteA, kSiteB, static_cast<double>(interval));
}

surgeon::GestureScript script_of(const FeltSetting& setting, double hand_stiffness) {
  surgeon::ScriptBuilder script{hand_stiffness};
  const Duration travel = TrialTimes{}.travel + milliseconds{50};
  for (std::size_t interval = 0; interval < setting.places.size(); ++interval) {
    script.site(place_of(interval)).hold(travel);
    if (interval == 0) script.move(surgeon::kNearPlace, kDown);
    for (const double depth : setting.places[interval].depth) script.taps(1, depth, kTap, kPause);
  }
  return script.hold(milliseconds{200}).build();
}

/// What is shown of each place is the estimator's last answer there that is one.
void tell_depths(const std::vector<DepthEstimate>& estimates, FeltTrial& felt) {
  for (std::size_t i = 0; i < felt.intervals.size(); ++i) {
    std::optional<double>& depth = felt.intervals[i].ball_depth;
    for (const DepthEstimate& one : estimates) {
      if (distance(one.place, place_of(i)) > kSamePlace) continue;
      if (one.verdict == DepthVerdict::Found) depth = one.depth;
      if (one.verdict == DepthVerdict::None) depth.reset();
    }
  }
}

/// Goes through a Trial with what a hand meets, and keeps what it felt.
class Listener {
 public:
  /// `step` [N] of forces that are drawn.
  Listener(std::size_t intervals, int taps, double step)
      : trial_{intervals, taps, false, TrialTimes{}},
        slopes_(intervals),
        drawn_(intervals, DrawnTaps{step}) {}

  /// `force` [N] at the hand, `tip_force` [N] at the tip.
  void tick(TimePoint now, double position, double force, double tip_force) {
    now_ = now;
    // A touch ends an interval, and is seen to its end.
    if (trial_.stage() == TrialStage::Explore) drawn_[trial_.interval()].see(position, tip_force);
    trial_.tick(now, {.force = force, .contact = tip_force > kContact});
    if (trial_.stage() == TrialStage::Explore) slopes_[trial_.interval()].feel(position, force);
    if (trial_.stage() == TrialStage::Answer && asked_ == 0) asked_ = seconds(trial_.length(now));
  }
  [[nodiscard]] FeltTrial heard() const {
    std::vector<FeltInterval> intervals;
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      intervals.push_back(
          {.ln_slopes = slopes_[i].ln_slopes(), .ln_drawn = drawn_[i].ln_stiffness()});
    }
    return {.intervals = std::move(intervals),
            .duration = asked_ > 0 ? asked_ : seconds(trial_.length(now_)),
            .taps = trial_.taps(),
            .force_max = trial_.force_max(),
            .contact = seconds(trial_.contact())};
  }

 private:
  Trial trial_;
  std::vector<FeltSlopes> slopes_;  ///< of each interval
  std::vector<DrawnTaps> drawn_;    ///< likewise
  TimePoint now_{};
  double asked_{};  ///< [s]
};

}  // namespace

struct FeltSession::Parts {
  lab::Scenario scenario;
  LevelCurves curves;

  /// `resisted`: the hand is given a force, and aims the deeper.
  [[nodiscard]] lab::Scenario with(const FeltSetting& setting, bool resisted) const {
    lab::Scenario out = scenario;
    out.seed = setting.seed;
    out.script = script_of(
        setting,
        resisted ? scenario.hand.plant.grip.stiffness : std::numeric_limits<double>::infinity());
    // A tissue is known at two places at least: where one is touched, plain tissue lies beside it.
    for (std::size_t i = 0; i < std::max<std::size_t>(2, setting.places.size()); ++i) {
      const double above = i < setting.places.size() ? setting.places[i].ln_stiffness : 0;
      out.phantom.survey.push_back({place_of(i), curves.at(above)});
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
  const lab::RunResult result = lab::simulate(parts_->with(setting, gives_force(feedback_)));
  Listener listener{setting.places.size(), taps_, parts_->scenario.tissue.force_quantum};
  for (const judge::RunTick& tick : result.ticks) {
    const TimePoint at = TimePoint{} + from_seconds(tick.at);
    listener.tick(at, tick.hand, tick.hand_force, tick.contact_force);
  }
  FeltTrial felt = judged_of(listener.heard());
  tell_depths(result.depths, felt);
  return felt;
}

FeltTrial FeltSession::touch(const FeltSetting& setting) const {
  Listener listener{setting.places.size(), taps_, 0};
  for (const lab::TouchTick& tick : lab::direct_touch(parts_->with(setting, true))) {
    listener.tick(TimePoint{} + tick.at, tick.position, tick.force, tick.force);
  }
  return judged_of(listener.heard());
}

}  // namespace palp::study
