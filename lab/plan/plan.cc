#include "lab/plan/plan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <optional>

#include "common/config/number.h"
#include "common/core/printable.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/direct_touch.h"
#include "surgeon_site/script_builder.h"
#include "surgeon_site/script_reader.h"

namespace palp::lab {
namespace {

constexpr double kRoundTripMaxMs = 10e3;  ///< [ms], twice what a path may delay

/// The middle of the hold of A's deep press in script time, and the operator's way there: the
/// blackout is placed in the channel's time, which starts with the run.
void place_blackout(Scenario& scenario) {
  Duration before{};
  for (const surgeon::Stretch& stretch : scenario.script.stretches()) {
    if (stretch.kind == surgeon::StretchKind::LiftMove) {
      before = stretch.began_at;
      break;
    }
  }
  scenario.blackout_at_script_time = before - std::chrono::seconds{1};
}

/// The middle of the nth stretch of a kind, in script time.
Duration middle_of(const surgeon::GestureScript& script, surgeon::StretchKind kind, int nth) {
  for (const surgeon::Stretch& stretch : script.stretches()) {
    if (stretch.kind == kind && --nth == 0) return stretch.began_at + stretch.duration / 2;
  }
  return script.length() / 2;
}

Duration fault_time(const surgeon::GestureScript& script, std::string_view place) {
  using surgeon::StretchKind;
  if (place == "tap") return middle_of(script, StretchKind::Tap, 2);
  if (place == "press") return middle_of(script, StretchKind::PressHold, 2);
  if (place == "press-b") return middle_of(script, StretchKind::PressHold, 4);
  return middle_of(script, StretchKind::Air, 1);
}

Result<void> apply(config::Document& document, const Setting& setting) {
  if (setting.path == "rtt_ms") {
    const auto trip = config::parse_number(setting.value);
    if (!trip || !(*trip >= 0 && *trip <= kRoundTripMaxMs)) {
      return fail("rtt_ms = " + printable(setting.value) +
                  (trip ? " is out of range: " : " is not a number: ") +
                  config::range_text(0, kRoundTripMaxMs, "ms"));
    }
    const std::string half = config::number_text(*trip / 2);
    auto up = document.set("up.delay_ms", half, setting.path);
    return up ? document.set("down.delay_ms", half, setting.path) : up;
  }
  // The words of a path are all that is said of it.
  if (setting.path == "up.spec" || setting.path == "down.spec") {
    const std::string path = setting.path.substr(0, setting.path.find('.') + 1);
    for (const char* number : {"delay_ms", "jitter_ms", "loss"}) {
      auto done = document.set(path + number, "0", setting.path);
      if (!done) return done;
    }
  }
  if (setting.path.rfind("coupling.", 0) == 0 || setting.path.rfind("loop.", 0) == 0) {
    auto surgeon = document.set("surgeon." + setting.path, setting.value, setting.path);
    if (!surgeon) return surgeon;
    return document.set("patient." + setting.path, setting.value, setting.path);
  }
  return document.set(setting.path, setting.value, setting.path);
}

void combine(const std::vector<std::vector<Setting>>& axes,
             std::size_t axis,
             std::vector<Setting>& chosen,
             const std::function<void(const std::vector<Setting>&)>& take) {
  if (axis == axes.size()) return take(chosen);
  for (const Setting& setting : axes[axis]) {
    chosen.push_back(setting);
    combine(axes, axis + 1, chosen, take);
    chosen.pop_back();
  }
}

constexpr std::string_view kPhantomPath = "patient.simulated_phantom.phantom";
constexpr std::string_view kCouplingPath = "coupling.name";
constexpr std::string_view kSeedPath = "seed";

/// PATH=VALUE,VALUE,...
Result<std::vector<Setting>> parse_axis(const std::string& axis) {
  const std::size_t equals = axis.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == axis.size()) {
    return fail("sweep axis '" + axis + "' must read PATH=VALUE,VALUE,...");
  }
  std::vector<Setting> values;
  std::size_t from = equals + 1;
  while (from <= axis.size()) {
    const std::size_t comma = std::min(axis.find(',', from), axis.size());
    if (comma == from) return fail("sweep axis '" + axis + "' has an empty value");
    values.push_back({axis.substr(0, equals), axis.substr(from, comma - from)});
    from = comma + 1;
  }
  return values;
}

/// What a program does in real time only, or what a sweep does not look at: an axis of it would be
/// the same case again and again.
Result<void> check_effect(const std::string& path) {
  struct Idle {
    std::string_view field;  ///< of a site, or of both
    std::string_view why;
  };
  constexpr std::array kIdle{
      Idle{"seed", "the run's own seed counts: seed or --seed"},
      Idle{"impairment.", "the path between the sites counts: up, down or rtt_ms"},
      Idle{"duration_s", "the run's own duration_s counts"},
      Idle{"give_up_after_s", "no program waits"},
      Idle{"peer", "there are no addresses"},
      Idle{"listen", "there are no addresses"},
      Idle{"record.", "no session file is kept"},
      Idle{"link.insecure", "there are no keys"},
      Idle{"link.identity", "there are no keys"},
      Idle{"link.rekey_after_s", "there are no keys"},
      Idle{"loop.spin_us", "nothing waits"},
      Idle{"loop.priority", "nothing waits"},
      Idle{"loop.lock_memory", "nothing waits"},
      Idle{"estimator.", "palp-lab depth judges the estimator"}};
  const std::size_t site = path.rfind("surgeon.", 0) == 0 || path.rfind("patient.", 0) == 0 ? 8 : 0;
  for (const Idle& idle : kIdle) {
    // The run has a seed and a duration of its own.
    const bool at_site = site > 0 || idle.field.rfind("loop.", 0) == 0;
    if (!at_site || path.compare(site, idle.field.size(), idle.field) != 0) continue;
    return fail(path + " changes nothing in a sweep: " + std::string{idle.why});
  }
  return {};
}

/// Of the first repeat: the sweep's, or what an axis says.
Result<std::uint64_t> first_seed(const std::vector<Setting>& settings, std::uint64_t seed) {
  for (const Setting& setting : settings) {
    if (setting.path != kSeedPath) continue;
    const auto value = config::parse_whole(setting.value);
    if (!value) return fail("seed = " + printable(setting.value) + " is not a whole number");
    seed = *value;
  }
  return seed;
}

}  // namespace

Result<Plan> make_sweep(const std::string& scenario,
                        const std::vector<std::string>& axes,
                        std::uint64_t repeats,
                        const PlanAsk& ask) {
  Plan plan;
  plan.name = "sweep";
  plan.scenario = scenario;
  plan.seed = ask.seed;
  const auto document = load_scenario(scenario);
  if (!document) return tl::unexpected(document.error());
  const auto base = make_scenario(scenario, *document);
  if (!base) return tl::unexpected(base.error());
  plan.coupling = ask.coupling.empty() ? base->coupling.name : ask.coupling;
  plan.tissue = ask.tissue.empty() ? base->phantom.name : ask.tissue;
  std::vector<std::vector<Setting>> values;
  for (const std::string& axis : axes) {
    auto list = parse_axis(axis);
    if (!list) return tl::unexpected(list.error());
    const std::string& path = list->front().path;
    if (auto effect = check_effect(path); !effect) return tl::unexpected(effect.error());
    const auto& names = plan.label_names;
    if (std::find(names.begin(), names.end(), path) != names.end()) {
      return fail(path + " has two axes: which of them?");
    }
    if (path == kCouplingPath) plan.coupling.clear();
    if (path == kPhantomPath) plan.tissue.clear();
    plan.label_names.push_back(path);
    values.push_back(std::move(*list));
  }
  std::optional<Error> fault;
  std::vector<Setting> chosen;
  combine(values, 0, chosen, [&](const std::vector<Setting>& settings) {
    const auto seed = first_seed(settings, ask.seed);
    if (!seed) {
      fault = seed.error();
      return;
    }
    for (std::uint64_t repeat = 0; repeat < repeats; ++repeat) {
      Case one;
      one.index = plan.cases.size();
      one.seed = *seed + repeat;
      one.settings = settings;
      if (!ask.coupling.empty())
        one.settings.insert(one.settings.begin(), {std::string{kCouplingPath}, ask.coupling});
      if (!ask.tissue.empty())
        one.settings.insert(one.settings.begin(), {std::string{kPhantomPath}, ask.tissue});
      for (const Setting& setting : settings) one.labels.push_back(setting.value);
      plan.cases.push_back(std::move(one));
    }
  });
  if (fault) return tl::unexpected(*fault);
  plan.count = plan.cases.size();
  return plan;
}

Result<Shard> parse_shard(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.part);
  const bool begun = first == std::errc{} && slash != end && *slash == '/';
  const auto [stop, second] =
      begun ? std::from_chars(slash + 1, end, shard.count) : std::from_chars_result{end, first};
  if (!begun || second != std::errc{} || stop != end || shard.count == 0 ||
      shard.part >= shard.count) {
    return fail("shard '" + text + "' must read i/n with 0 <= i < n");
  }
  return shard;
}

void keep_shard(Plan& plan, const Shard& shard) {
  std::erase_if(plan.cases, [&](const Case& one) { return one.index % shard.count != shard.part; });
}

Result<Scenario> make_case(const Plan& plan, const Case& one) {
  auto document = load_scenario(plan.scenario);
  if (!document) return tl::unexpected(document.error());
  for (const Setting& setting : one.settings) {
    if (auto done = apply(*document, setting); !done) return tl::unexpected(done.error());
  }
  if (auto done = document->set("seed", std::to_string(one.seed), "seed"); !done) {
    return tl::unexpected(done.error());
  }
  if (auto checked = document->check(); !checked) return tl::unexpected(checked.error());
  auto scenario = make_scenario(plan.scenario, *document);
  if (!scenario) return scenario;
  scenario->bare = true;
  scenario->depths = false;
  if (!one.script.empty()) {
    auto script = surgeon::parse_script(one.script, scenario->hand.plant.grip.stiffness);
    if (!script) return tl::unexpected(script.error());
    scenario->script = std::move(*script);
  }
  if (plan.direct_touch) scenario->finger = own_finger(*scenario);
  scenario->lying = plan.lying || one.lying;
  if (plan.blackout) place_blackout(*scenario);
  if (one.fault.kind == FaultKind::None) return scenario;
  scenario->fault = one.fault;
  scenario->fault.at_script_time =
      one.fault_place.empty() ? from_seconds(one.fault_share * seconds(scenario->script.length()))
                              : fault_time(scenario->script, one.fault_place);
  return scenario;
}

}  // namespace palp::lab
