#include "study/closed_loop/felt_trial.h"

#include <cmath>
#include <utility>

#include "lab/plan/scenario_file.h"
#include "lab/run/direct_touch.h"
#include "lab/run/run.h"
#include "patient_site/force_table.h"
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
  scenario->depths = false;
  if (!condition.force) scenario->surgeon.gate.force_max = 0;
  return scenario;
}

patient::ForceTable scaled(const patient::ForceTable& table, double ln_factor) {
  std::vector<patient::ForceRow> rows{table.rows().begin(), table.rows().end()};
  for (patient::ForceRow& row : rows) row.force *= std::exp(ln_factor);
  return patient::ForceTable::make(std::move(rows)).value();
}

surgeon::GestureScript script_of(const FeltSetting& setting, double hand_stiffness) {
  surgeon::ScriptBuilder script{hand_stiffness};
  const Duration travel = TrialTimes{}.travel + milliseconds{50};
  for (std::size_t interval = 0; interval < 2; ++interval) {
    script.site(interval == 0 ? kSiteA : kSiteB).hold(travel);
    if (interval == 0) script.move(surgeon::kNearPlace, kDown);
    for (const double depth : setting.depth[interval]) script.taps(1, depth, kTap, kPause);
  }
  return script.hold(milliseconds{200}).build();
}

/// Goes through a Trial with what a hand meets, and keeps what it felt.
class Listener {
 public:
  explicit Listener(int taps) : trial_{2, taps, false, TrialTimes{}} {}

  void tick(TimePoint now, double position, double force, bool contact) {
    now_ = now;
    trial_.tick(now, {.force = force, .contact = contact});
    if (trial_.stage() == TrialStage::Explore) slopes_[trial_.interval()].feel(position, force);
    if (trial_.stage() == TrialStage::Answer && asked_ == 0) asked_ = seconds(trial_.length(now));
  }
  [[nodiscard]] FeltTrial heard() const {
    return {.ln_slopes = {slopes_[0].ln_slopes(), slopes_[1].ln_slopes()},
            .duration = asked_ > 0 ? asked_ : seconds(trial_.length(now_)),
            .taps = trial_.taps(),
            .force_max = trial_.force_max(),
            .contact = seconds(trial_.contact())};
  }

 private:
  Trial trial_;
  std::array<FeltSlopes, 2> slopes_;
  TimePoint now_{};
  double asked_{};  ///< [s]
};

}  // namespace

struct FeltSession::Parts {
  lab::Scenario scenario;

  [[nodiscard]] lab::Scenario with(const FeltSetting& setting) const {
    lab::Scenario out = scenario;
    out.seed = setting.seed;
    out.script = script_of(setting, scenario.hand.plant.grip.stiffness);
    out.phantom.plain = scaled(scenario.phantom.plain, setting.ln_stiffness[0]);
    out.phantom.over = scaled(scenario.phantom.plain, setting.ln_stiffness[1]);
    return out;
  }
};

FeltSession::FeltSession(std::unique_ptr<Parts> parts, int taps) noexcept
    : parts_{std::move(parts)}, taps_{taps} {}
FeltSession::FeltSession(FeltSession&& other) noexcept = default;
FeltSession& FeltSession::operator=(FeltSession&& other) noexcept = default;
FeltSession::~FeltSession() = default;

Result<FeltSession> FeltSession::make(const Condition& condition) {
  auto scenario = scenario_of(condition);
  if (!scenario) return tl::unexpected(scenario.error());
  return FeltSession{std::make_unique<Parts>(Parts{std::move(*scenario)}), condition.taps};
}

FeltTrial FeltSession::feel(const FeltSetting& setting) const {
  const lab::RunResult result = lab::simulate(parts_->with(setting));
  Listener listener{taps_};
  for (const judge::RunTick& tick : result.ticks) {
    const TimePoint at = TimePoint{} + from_seconds(tick.at);
    listener.tick(at, tick.hand, tick.hand_force, tick.contact_force > kContact);
  }
  return listener.heard();
}

FeltTrial FeltSession::touch(const FeltSetting& setting) const {
  Listener listener{taps_};
  for (const lab::TouchTick& tick : lab::direct_touch(parts_->with(setting))) {
    listener.tick(TimePoint{} + tick.at, tick.position, tick.force, tick.force > kContact);
  }
  return listener.heard();
}

}  // namespace palp::study
