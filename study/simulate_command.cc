#include "study/simulate_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/config/json.h"
#include "common/config/report.h"
#include "study/compare.h"
#include "study/known_truth.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;

/// What is printed and what is written.
struct Outcome {
  std::string text;
  Json rows;
  bool held{true};  ///< no target was missed
};

RecoverySet set_of(const SimulateFlags& flags) {
  RecoverySet set{.task = {.intervals = static_cast<int>(flags.intervals)},
                  .jnd_min = flags.jnd_min,
                  .jnd_max = flags.jnd_max,
                  .lapse_min = flags.lapse_min,
                  .lapse_max = flags.lapse_max,
                  .seed = flags.seed};
  set.method.kind = *std::ranges::find(
      kMethods, std::string_view{flags.method}, [](MethodKind kind) { return to_string(kind); });
  set.method.stop = {.trials_min = flags.trials, .trials_max = flags.trials};
  // A staircase ends by its reversals.
  if (set.method.kind == MethodKind::Staircase) set.method.stop.trials_max = 10 * flags.trials;
  return set;
}

Outcome recovered(const SimulateFlags& flags, const ForEachIndex& for_each_index) {
  const RecoverySet set = set_of(flags);
  const RecoverySummary found = summary_of(set, recover(set, flags.observers, for_each_index));
  std::array<char, 512> text{};
  std::snprintf(text.data(),
                text.size(),
                "%s, %llu observers, %.0f trials each\n"
                "bias of ln JND            %+.3f\n"
                "standard deviation         %.3f\n"
                "Cramer-Rao bound           %.3f\n"
                "95 %% intervals hold        %.1f %%\n",
                flags.method.c_str(),
                static_cast<unsigned long long>(flags.observers),
                found.trials,
                found.bias,
                found.sd,
                found.bound,
                100 * found.held);
  return {text.data(),
          Json{{"trials_mean", found.trials},
               {"ln_jnd_bias", found.bias},
               {"ln_jnd_sd", found.sd},
               {"ln_jnd_bound", found.bound},
               {"held_share", found.held}}};
}

Outcome grouped(const SimulateFlags& flags, const ForEachIndex& for_each_index) {
  const GroupSet set{.observers = set_of(flags),
                     .participants = flags.participants,
                     .condition_ln = std::log(flags.ratio),
                     .margin = flags.margin};
  const GroupSummary found = repeat_group(set, flags.observers, for_each_index);
  std::array<char, 512> text{};
  std::snprintf(text.data(),
                text.size(),
                "%llu experiments of %llu participants, JND of two conditions 1 to %g\n"
                "a difference is found       %5.1f %%\n"
                "called equal within %.2f    %5.1f %%\n"
                "95 %% interval holds truth   %5.1f %%\n",
                static_cast<unsigned long long>(flags.observers),
                static_cast<unsigned long long>(flags.participants),
                flags.ratio,
                100 * found.found,
                flags.margin,
                100 * found.equal,
                100 * found.held);
  return {
      text.data(),
      Json{{"found_share", found.found}, {"equal_share", found.equal}, {"held_share", found.held}}};
}

Outcome yes_or_no(const SimulateFlags& flags) {
  Outcome out{"  d'   bias of d'  held %   bias of criterion  held %\n", Json::array()};
  for (const double d_prime : kKnownSensitivities) {
    const YesNoSummary found =
        recover_yes_no(d_prime, kKnownCriterion, flags.trials, flags.observers, flags.seed);
    std::array<char, 128> line{};
    std::snprintf(line.data(),
                  line.size(),
                  "%4.1f        %+.3f   %5.1f              %+.3f   %5.1f\n",
                  d_prime,
                  found.d_prime_bias,
                  100 * found.d_prime_held,
                  found.criterion_bias,
                  100 * found.criterion_held);
    out.text += line.data();
    out.rows.push_back(Json{{"d_prime", d_prime},
                            {"d_prime_bias", found.d_prime_bias},
                            {"d_prime_held_share", found.d_prime_held},
                            {"criterion_bias", found.criterion_bias},
                            {"criterion_held_share", found.criterion_held}});
  }
  return out;
}

Outcome known(const SimulateFlags& flags, const ForEachIndex& for_each_index) {
  const std::vector<Target> targets = known_truth(flags.observers, flags.seed, for_each_index);
  Outcome out{targets_text(targets), Json::array()};
  for (const Target& one : targets) {
    out.held = out.held && one.holds();
    out.rows.push_back(Json{{"what", one.what},
                            {"found", one.found},
                            {"low", one.low},
                            {"high", one.high},
                            {"holds", one.holds()}});
  }
  return out;
}

}  // namespace

void declare_simulate(config::CommandLine& line, SimulateFlags& flags) {
  line.choice("--set",
              flags.set,
              {"recover", "group", "yes-no", "known-truth"},
              "one observer each; whole experiments of two conditions; yes or no; all methods "
              "against their targets, with --count and --seed alone");
  line.choice("--method",
              flags.method,
              {"constant", "staircase", "quest", "quest-plus"},
              "what chooses the levels");
  line.whole("--intervals", flags.intervals, {.min = 2, .max = 8}, "of the forced choice");
  line.whole("--count",
             flags.observers,
             {.min = 2, .max = 1'000'000},
             "observers; with --set group experiments");
  line.whole("--trials",
             flags.trials,
             {.min = 5, .max = 10'000},
             "of each observer; yes-no: of each kind");
  line.number("--jnd-min", flags.jnd_min, {.min = 0.02, .max = 1.5}, "least JND, of ln");
  line.number("--jnd-max", flags.jnd_max, {.min = 0.02, .max = 1.5}, "greatest JND, of ln");
  line.number("--lapse-min", flags.lapse_min, {.min = 0, .max = 0.5}, "least lapse rate");
  line.number("--lapse-max", flags.lapse_max, {.min = 0, .max = 0.5}, "greatest lapse rate");
  line.whole("--participants", flags.participants, {.min = 2, .max = 1000}, "with --set group");
  line.number("--ratio",
              flags.ratio,
              {.min = 0.2, .max = 5},
              "with --set group: JND of the second condition over the first");
  line.number("--margin",
              flags.margin,
              {.min = 0.01, .max = 1},
              "with --set group: of ln JND, called equal within it");
  line.whole("--seed", flags.seed, {.min = 0, .max = 9007199254740991}, "of everything random");
  line.report(flags.report, "palp.study_simulation/1");
}

ExitStatus run_simulate(const SimulateFlags& flags, const ForEachIndex& for_each_index) {
  if (flags.jnd_min > flags.jnd_max) {
    return {ExitCode::BadInput, "palp-study: --jnd-min must not be above --jnd-max"};
  }
  if (flags.lapse_min > flags.lapse_max) {
    return {ExitCode::BadInput, "palp-study: --lapse-min must not be above --lapse-max"};
  }
  const Outcome outcome = flags.set == "recover"       ? recovered(flags, for_each_index)
                          : flags.set == "group"       ? grouped(flags, for_each_index)
                          : flags.set == "known-truth" ? known(flags, for_each_index)
                                                       : yes_or_no(flags);
  if (!flags.report.empty()) {
    Json report{{"schema", "palp.study_simulation/1"},
                {"set", flags.set},
                {"method", flags.method},
                {"count", flags.observers},
                {"trials", flags.trials},
                {"seed", flags.seed}};
    report["result"] = outcome.rows;
    const auto written = config::write_whole_file(flags.report, report.dump(2) + "\n");
    if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  }
  if (outcome.held) return {ExitCode::Done, outcome.text};
  (void)std::fputs(outcome.text.c_str(), stdout);
  return {ExitCode::Missed, "palp-study: a target was missed"};
}

void declare_power(config::CommandLine& line, PowerFlags& flags) {
  line.number("--ratio", flags.ratio, {.min = 1.01, .max = 10}, "of JND, that is to be found");
  line.number("--sd",
              flags.sd,
              {.min = 0.01, .max = 3},
              "standard deviation of participants' differences of ln JND");
  line.number("--power", flags.power, {.min = 0.1, .max = 0.999}, "share of studies that find it");
}

ExitStatus run_power(const PowerFlags& flags) {
  const int needed = participants_needed(std::log(flags.ratio), flags.sd, flags.power);
  return {ExitCode::Done, std::to_string(needed) + " participants\n"};
}

}  // namespace palp::study
