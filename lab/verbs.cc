#include "lab/verbs.h"

#include <algorithm>
#include <cstdio>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/config/settings_text.h"
#include "common/core/whole_file.h"
#include "common/coupling/any_coupling.h"
#include "judge/metric_table.h"
#include "lab/depth_command.h"
#include "lab/partial_cases.h"
#include "lab/report/batch_report.h"
#include "lab/report/depth_cases.h"
#include "lab/report/metric_plot.h"
#include "lab/report/stability_map.h"

namespace palp::lab {
namespace {

constexpr const char* kMontecarlo = "palp.montecarlo/1";
constexpr const char* kAdversary = "palp.adversary/1";
constexpr const char* kCompare = "palp.compare/1";
constexpr const char* kMap = "palp.map/1";
constexpr const char* kSweep = "palp.sweep/1";
constexpr std::string_view kMapName = "map";
constexpr std::string_view kSweepName = "sweep";

using config::ExitCode;
using config::ExitStatus;

constexpr std::uint64_t kSeedMax = 9007199254740991;  // what a JSON number holds exactly

/// Writes what was asked for; the error, if any.
std::optional<ExitStatus> write_files(const std::vector<std::pair<std::string, std::string>>& files,
                                      const plot::Figure& figure,
                                      const plot::PictureFlags& picture) {
  for (const auto& [path, text] : files) {
    if (path.empty()) continue;
    if (const auto written = config::write_whole_file(path, text); !written) {
      return ExitStatus{ExitCode::CannotOpen, "palp-lab: " + written.error().text};
    }
  }
  if (const auto drawn = plot::write_picture(figure, picture); !drawn) {
    return ExitStatus{ExitCode::CannotOpen, "palp-lab: " + drawn.error().text};
  }
  return std::nullopt;
}

/// Before hours are spent on what nobody could write down.
std::optional<ExitStatus> check_files(const BatchArguments& arguments) {
  auto can = config::can_write_files({arguments.cases, arguments.report, arguments.csv});
  if (can) can = plot::can_write_picture(arguments.picture);
  if (can) return std::nullopt;
  return ExitStatus{ExitCode::CannotOpen, "palp-lab: " + can.error().text};
}

std::string set_of(const BatchArguments& arguments) {
  return arguments.set.empty() ? "mc" : arguments.set;
}

PlanAsk ask_of(const BatchArguments& arguments) {
  PlanAsk ask;
  ask.count = arguments.count;
  ask.seed = arguments.seed.value_or(1);
  if (!arguments.coupling.empty()) ask.coupling = arguments.coupling;
  if (!arguments.tissue.empty()) ask.tissue = arguments.tissue;
  return ask;
}

struct Run {
  Plan plan;
  std::vector<CaseResult> results;
  BatchAccount account;
};

Result<void> check_metric(const BatchArguments& arguments) {
  if (judge::metric_index(arguments.metric)) return {};
  std::string sentence = "there is no metric '" + arguments.metric + "', there are:";
  for (const judge::Metric& metric : judge::metric_table())
    sentence.append(" ").append(metric.name);
  return fail(sentence);
}

/// Runs what no interrupted batch before left in `kept`.
Result<std::vector<CaseResult>> run_missing(Plan plan,
                                            const BatchArguments& arguments,
                                            const Machine& machine,
                                            std::size_t cores) {
  std::vector<CaseResult> results;
  auto kept = PartialCases::begin(
      arguments.keeps_rows ? arguments.cases : "", arguments.resume, plan, results);
  if (!kept) return tl::unexpected(kept.error());
  auto made = run_plan(
      plan,
      [&](std::size_t count, const std::function<void(std::size_t)>& work) {
        machine.for_each_index(count, cores, work);
      },
      shown_progress(machine),
      [&](const CaseResult& result) { kept->add(plan, result); });
  if (!made) return tl::unexpected(made.error());
  results.insert(results.end(), made->begin(), made->end());
  std::sort(results.begin(), results.end(), [](const CaseResult& a, const CaseResult& b) {
    return a.index < b.index;
  });
  return results;
}

Result<Run> run(Plan plan, const BatchArguments& arguments, const Machine& machine) {
  if (auto known = check_metric(arguments); !known) return tl::unexpected(known.error());
  if (!arguments.shard.empty()) {
    const auto shard = parse_shard(arguments.shard);
    if (!shard) return tl::unexpected(shard.error());
    keep_shard(plan, *shard);
  }
  const std::size_t cores = arguments.cores.value_or(machine.processors);
  plan.made_by = machine.made_by;
  const auto begin = machine.used();
  auto results = run_missing(plan, arguments, machine, cores);
  if (!results) return tl::unexpected(results.error());
  const auto end = machine.used();
  BatchAccount account;
  account.shard = arguments.shard;
  account.cores = cores;
  account.cpu = end.first - begin.first;
  account.wall = end.second - begin.second;
  account.cases_csv = arguments.cases;
  return Run{std::move(plan), std::move(*results), account};
}

plot::Figure figure_of(const Run& done, const std::string& metric, const std::string& title) {
  return metric_plot(done.plan.label_names, done.results, metric, title);
}

ExitStatus finish(const Run& done, const BatchArguments& arguments, const plot::Figure& figure) {
  if (auto failed =
          write_files({{arguments.cases, cases_csv(done.plan, done.results)},
                       {arguments.report, batch_report(done.plan, done.results, done.account)}},
                      figure,
                      arguments.picture)) {
    return *failed;
  }
  if (done.account.cores > 0) remove_partial_rows(arguments.cases);  // none of a merge
  return {ExitCode::Done, batch_summary(done.plan, done.results, done.account)};
}

ExitStatus montecarlo(const BatchArguments& arguments, const Machine& machine, bool lying) {
  auto plan = make_set(lying ? "mc-adv" : set_of(arguments), ask_of(arguments));
  if (!plan) return refusal(plan.error());
  auto done = run(std::move(*plan), arguments, machine);
  if (!done) return refusal(done.error());
  if (lying) done->account.schema = kAdversary;
  return finish(*done, arguments, figure_of(*done, arguments.metric, "set " + done->plan.name));
}

ExitStatus sweep(const BatchArguments& arguments, const Machine& machine) {
  PlanAsk ask = ask_of(arguments);
  // What is not asked for stays as the scenario has it.
  ask.coupling = arguments.coupling;
  ask.tissue = arguments.tissue;
  auto plan = make_sweep(arguments.scenario, arguments.list, arguments.repeats, ask);
  if (!plan) return refusal(plan.error());
  // A value that cannot be is refused before the first case is run.
  for (std::size_t i = 0; i < plan->cases.size(); i += arguments.repeats) {
    if (const auto one = make_case(*plan, plan->cases[i]); !one) return refusal(one.error());
  }
  auto done = run(std::move(*plan), arguments, machine);
  if (!done) return refusal(done.error());
  done->account.schema = kSweep;
  return finish(
      *done, arguments, figure_of(*done, arguments.metric, "sweep of " + arguments.scenario));
}

/// What a map has to say, run here or merged.
ExitStatus finish_map(const Run& done, const BatchArguments& arguments) {
  if (auto failed =
          write_files({{arguments.cases, cases_csv(done.plan, done.results)},
                       {arguments.report, map_report(done.plan, done.results, done.account)}},
                      map_figure(done.results),
                      arguments.picture)) {
    return *failed;
  }
  if (done.account.cores > 0) remove_partial_rows(arguments.cases);  // none of a merge
  return {ExitCode::Done, map_text(done.results)};
}

ExitStatus map(const BatchArguments& arguments, const Machine& machine) {
  if (!arguments.coupling.empty() && arguments.coupling != "direct") {
    return refusal({"the map is that of eq. (1): coupling direct"});
  }
  auto done = run(make_map(ask_of(arguments)), arguments, machine);
  if (!done) return refusal(done.error());
  return finish_map(*done, arguments);
}

ExitStatus compare(const BatchArguments& arguments, const Machine& machine) {
  std::string text;
  config::Json json;
  json["schema"] = kCompare;
  Run all;
  for (const std::string_view name : coupling::kCouplingNames) {
    BatchArguments one = arguments;
    one.coupling = name;
    one.keeps_rows = false;  // four plans, one file
    auto plan = make_set(set_of(one), ask_of(one));
    if (!plan) return refusal(plan.error());
    auto done = run(std::move(*plan), one, machine);
    if (!done) return refusal(done.error());
    text += batch_summary(done->plan, done->results, done->account) + "\n";
    json["couplings"][one.coupling] =
        config::Json::parse(batch_report(done->plan, done->results, done->account));
    const std::uint64_t before = all.plan.count;
    all.plan = done->plan;
    all.plan.count += before;
    for (CaseResult& result : done->results) {
      result.labels.push_back(one.coupling);
      result.index += before;
      all.results.push_back(std::move(result));
    }
  }
  all.plan.coupling.clear();
  all.plan.label_names.emplace_back("coupling");
  if (auto failed = write_files({{arguments.report, json.dump(2) + "\n"},
                                 {arguments.cases, cases_csv(all.plan, all.results)}},
                                figure_of(all, arguments.metric, "set " + all.plan.name),
                                arguments.picture)) {
    return *failed;
  }
  return {ExitCode::Done, text};
}

/// What the flags say of merged cases must be what their rows say.
Result<void> check_meant(const Plan& plan, const BatchArguments& arguments) {
  const auto same = [](const char* flag, const std::string& said, const std::string& is) {
    return said.empty() || said == is
               ? Result<void>{}
               : fail(std::string{flag} + " = " + said + ", but the cases are of " + is);
  };
  const std::string seed = arguments.seed ? std::to_string(*arguments.seed) : "";
  for (const auto& agreed : {same("--set", arguments.set, plan.name),
                             same("--coupling", arguments.coupling, plan.coupling),
                             same("--tissue", arguments.tissue, plan.tissue),
                             same("--seed", seed, std::to_string(plan.seed))}) {
    if (!agreed) return agreed;
  }
  return {};
}

ExitStatus merge_depth_of(const BatchArguments& arguments) {
  if (!arguments.set.empty() || !arguments.coupling.empty() || !arguments.tissue.empty()) {
    return refusal({"merge: the cases are of depth, which has no --set, --coupling or --tissue"});
  }
  DepthFlags flags;
  flags.report = arguments.report;
  flags.csv = arguments.csv;
  flags.picture = arguments.picture;
  flags.cases = arguments.cases;
  return merge_depth(arguments.list, flags);
}

ExitStatus merge(const BatchArguments& arguments) {
  if (auto known = check_metric(arguments); !known) return refusal(known.error());
  Run all;
  for (const std::string& path : arguments.list) {
    const auto text = read_whole_file(path, kCasesSizeMax);
    if (!text) return {ExitCode::CannotOpen, "palp-lab: " + text.error().text};
    if (is_depth_cases(*text)) return merge_depth_of(arguments);
    auto rows = read_cases_csv(*text, path, all.plan);
    if (!rows) return refusal(rows.error());
    all.results.insert(all.results.end(), rows->begin(), rows->end());
  }
  std::stable_sort(all.results.begin(), all.results.end(), [](const auto& a, const auto& b) {
    return a.index < b.index;
  });
  if (auto whole = check_complete(all.plan, all.results); !whole) return refusal(whole.error());
  if (auto meant = check_meant(all.plan, arguments); !meant) return refusal(meant.error());
  warn_of_makers(makers(all.plan, all.results));
  if (all.plan.name == kMapName) return finish_map(all, arguments);
  if (all.plan.name == kSweepName) all.account.schema = kSweep;
  return finish(all, arguments, figure_of(all, arguments.metric, "set " + all.plan.name));
}

void declare_common(config::CommandLine& verb, BatchArguments& arguments, const char* schema) {
  verb.whole("--seed", arguments.seed, {.min = 0, .max = kSeedMax}, "of everything random; 1");
  verb.report(arguments.report, schema);
  verb.output("--cases", arguments.cases, "one row per case as CSV");
  plot::declare_picture(verb, arguments.picture, "a picture");
}

void declare_running(config::CommandLine& verb, BatchArguments& arguments, const char* schema) {
  declare_common(verb, arguments, schema);
  verb.text("--shard", arguments.shard, "I/N", "only every Nth case, from the Ith on");
  verb.whole("--cores", arguments.cores, {.min = 1, .max = 1024}, "threads; else one a processor");
}

void declare_spread(config::CommandLine& verb, BatchArguments& arguments, const char* schema) {
  declare_running(verb, arguments, schema);
  verb.toggle("--resume", arguments.resume, "only the cases that FILE.partial of --cases lacks");
  config::declare_submission(verb, arguments.submission);
}

}  // namespace

Progress shown_progress(const Machine& machine) {
  if (!machine.watched) return {};
  return [&machine, begin = machine.used().second](std::size_t done, std::size_t count) {
    const double rate = static_cast<double>(done) / std::max(1e-3, machine.used().second - begin);
    const double left = static_cast<double>(count - done) / rate;
    static_cast<void>(std::fprintf(
        stderr, "\r%zu of %zu, %.1f a second, %.0f s left\x1b[K", done, count, rate, left));
    if (done == count) static_cast<void>(std::fprintf(stderr, "\r\x1b[K"));
  };
}

void warn_of_makers(const std::vector<std::string>& makers) {
  if (makers.size() < 2) return;
  std::string all;
  for (const std::string& one : makers) all += (all.empty() ? "" : "; ") + one;
  static_cast<void>(
      std::fprintf(stderr,
                   "palp-lab: warning: not all cases were made by one program and processor: %s\n",
                   all.c_str()));
}

config::ShardForm shard_form() {
  return {.program = "palp-lab",
          .part_flag = "--cases",
          .part_ending = ".csv",
          .resume = "--resume",
          .of_merge = {"--report", "--cases", "--svg", "--pdf", "--style", "--metric", "--csv"}};
}

void declare_batch_verbs(config::CommandLine& line, BatchArguments& arguments) {
  const auto tissue_flag = [&](config::CommandLine& verb) {
    verb.text("--tissue", arguments.tissue, "NAME", "closed-form, fe, or a phantom; closed-form");
  };
  const auto set_flags = [&](config::CommandLine& verb, bool with_set) {
    tissue_flag(verb);
    if (with_set) {
      verb.text("--set", arguments.set, "NAME", "which (palp-lab scenarios lists them); mc");
    }
    verb.whole("--count", arguments.count, {.min = 1, .max = 1000000}, "cases of a random set");
    verb.text("--metric", arguments.metric, "NAME", "what the picture shows; tap_a_error");
  };
  auto& monte = line.verb("montecarlo", "a set of scenarios: errors, energies, stability");
  set_flags(monte, true);
  monte.text("--coupling", arguments.coupling, "NAME", "direct, wave, tdpa or mmt; mmt");
  declare_spread(monte, arguments, kMontecarlo);
  auto& liar = line.verb("adversary", "random cases with a patient site that lies");
  set_flags(liar, false);
  liar.text("--coupling", arguments.coupling, "NAME", "direct, wave, tdpa or mmt; mmt");
  declare_spread(liar, arguments, kAdversary);
  auto& side_by_side = line.verb("compare", "a set with every coupling");
  set_flags(side_by_side, true);
  declare_running(side_by_side, arguments, kCompare);
  auto& stability = line.verb("map", "stability of eq. (1): spring, round trip, grip");
  stability.text("--coupling", arguments.coupling, "NAME", "direct");
  tissue_flag(stability);
  declare_spread(stability, arguments, kMap);
  auto& axes = line.verb("sweep", "all combinations of settings: PATH=VALUE,VALUE,...");
  axes.text("--scenario", arguments.scenario, "NAME", "what they change; standard");
  axes.text("--coupling",
            arguments.coupling,
            "NAME",
            "instead of the scenario's: direct, wave, tdpa or mmt");
  axes.whole("--repeats", arguments.repeats, {.min = 1, .max = 100000}, "seeds of each; 1");
  axes.text("--tissue", arguments.tissue, "PHANTOM", "instead of the scenario's");
  axes.text("--metric", arguments.metric, "NAME", "what the picture shows; tap_a_error");
  axes.arguments(
      "AXIS", arguments.list, "PATH=VALUE,VALUE,...; coupling.*, loop.* at both sites; rtt_ms");
  axes.required();
  declare_spread(axes, arguments, kSweep);
  auto& joined = line.verb("merge", "cases files of all shards become one report");
  joined.text("--set", arguments.set, "NAME", "refuse cases of another");
  joined.text("--coupling", arguments.coupling, "NAME", "refuse cases of another");
  tissue_flag(joined);
  joined.text("--metric", arguments.metric, "NAME", "what the picture shows; tap_a_error");
  joined.output("--csv", arguments.csv, "of depth: a line per case");
  joined.arguments("FILE", arguments.list, "as --cases wrote them");
  joined.required();
  declare_common(joined, arguments, kMontecarlo);
}

std::optional<ExitStatus> run_batch_verb(const std::string& verb,
                                         const BatchArguments& arguments,
                                         const Machine& machine) {
  if (auto closed = check_files(arguments)) return closed;
  if (verb == "montecarlo") return montecarlo(arguments, machine, false);
  if (verb == "adversary") return montecarlo(arguments, machine, true);
  if (verb == "compare") return compare(arguments, machine);
  if (verb == "map") return map(arguments, machine);
  if (verb == "sweep") return sweep(arguments, machine);
  if (verb == "merge") return merge(arguments);
  return std::nullopt;
}

}  // namespace palp::lab
