#include "lab/locate_command.h"

#include <mutex>
#include <utility>
#include <vector>

#include "common/config/exit_code.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "lab/plan/locate_study.h"
#include "lab/report/locate_picture.h"

namespace palp::lab {

using config::ExitCode;
using config::ExitStatus;

namespace {
constexpr double kLengthLeastMm = 2;  // as the words of a tissue have it

/// Rows of a square pattern of so many places; 0: it is none.
std::uint32_t rows_for(std::uint64_t taps) {
  for (std::uint32_t rows = 2; rows <= 10; ++rows) {
    if (std::uint64_t{rows} * rows == taps) return rows;
  }
  return 0;
}

bool is_session(const LocateFlags& flags) {
  return flags.session || flags.round_trip_ms > 0 || flags.loss > 0;
}

/// Flags that contradict one another, in a sentence.
Result<void> agreement(const LocateFlags& flags) {
  const LocateFlags usual;
  const bool pattern_given = flags.taps != usual.taps || flags.pitch_mm != usual.pitch_mm;
  if (rows_for(flags.taps) == 0) return fail("--taps is a square number from 4 to 100");
  if (pattern_given && (flags.search || is_session(flags))) {
    return fail("--taps and --pitch-mm go neither with --search nor with a session");
  }
  if (!flags.rule.empty() && (!flags.search || is_session(flags))) {
    return fail("--rule needs --search, and no session");
  }
  if (!flags.set.empty() &&
      (flags.search || is_session(flags) || !flags.ball.empty() || flags.heterogeneity > 0 ||
       flags.e_kpa != usual.e_kpa || flags.told_kpa || flags.depth_max_mm != usual.depth_max_mm)) {
    return fail(
        "--set brings worlds and taps of its own: of the other flags that describe them "
        "only --taps, --pitch-mm and --assumed-spread go with it");
  }
  if (is_session(flags) && flags.depth_max_mm != usual.depth_max_mm) {
    return fail("--depth-max-mm goes with no session");
  }
  const bool by_place = !flags.search && !is_session(flags) && flags.length_mm == 0;
  if (flags.length_mm < kLengthLeastMm && !by_place) {
    return fail("--heterogeneity-length-mm is 2 or more, or 0 where the places are a pattern's");
  }
  return {};
}

LocateStudy study_of(const LocateFlags& flags, const Machine& machine) {
  LocateStudy study{.count = static_cast<std::uint32_t>(flags.count),
                    .seed = flags.seed,
                    .rows = rows_for(flags.taps),
                    .pitch = flags.pitch_mm * kMillimetre,
                    .spread = flags.heterogeneity,
                    .length = flags.length_mm * kMillimetre,
                    .assumed_spread = flags.assumed_spread,
                    .modulus = 1e3 * flags.e_kpa,
                    .told = 1e3 * flags.told_kpa.value_or(flags.e_kpa),
                    .depth_max = flags.depth_max_mm * kMillimetre,
                    .mismatch = flags.set == "mismatch",
                    .round_trip = 1e-3 * flags.round_trip_ms,
                    .loss = flags.loss};
  if (machine.used) study.clock = [&machine] { return machine.used().second; };
  if (is_session(flags)) {
    study.script = flags.search ? "search" : "map";
    return study;
  }
  if (flags.search) study.rule = TapRule::Search;
  for (std::size_t i = 0; i < kTapRuleNames.size(); ++i) {
    if (flags.rule == kTapRuleNames[i]) study.rule = static_cast<TapRule>(i);
  }
  return study;
}
}  // namespace

void declare_locate(config::CommandLine& line, LocateFlags& flags) {
  line.whole("--count", flags.count, {.min = 1, .max = 100'000}, "random phantoms, and plain ones");
  line.whole("--seed", flags.seed, {.min = 0, .max = 9007199254740991}, "of everything random");
  line.whole("--taps", flags.taps, {.min = 4, .max = 100}, "of a square pattern");
  line.number(
      "--pitch-mm", flags.pitch_mm, {.min = 2, .max = 30, .unit = "mm"}, "between its places");
  line.number("--heterogeneity",
              flags.heterogeneity,
              {.min = 0, .max = 0.3},
              "share by which the tissue's stiffness varies from place to place");
  line.number("--heterogeneity-length-mm",
              flags.length_mm,
              {.min = 0, .max = 200, .unit = "mm"},
              "over which it varies; 0: anew at each place of a pattern");
  line.number("--assumed-spread",
              flags.assumed_spread,
              {.min = 0, .max = 0.3},
              "what the estimator assumes of that");
  line.number("--e-kpa",
              flags.e_kpa,
              {.min = 1, .max = 200, .unit = "kPa"},
              "Young's modulus of the tissue, within 10 %");
  line.number("--told-kpa",
              flags.told_kpa,
              {.min = 1, .max = 200, .unit = "kPa"},
              "what the estimator is told of it; else the same");
  line.number("--depth-max-mm",
              flags.depth_max_mm,
              {.min = 5, .max = 27, .unit = "mm"},
              "deepest ball that is drawn, and that the estimator looks for");
  line.text("--ball",
            flags.ball,
            "WORDS",
            "the one ball of all cases: depth=10 radius=15 ratio=856 at=2,1 (from the middle)");
  line.choice("--set",
              flags.set,
              {"mismatch"},
              "worlds that are not as the estimator assumes, instead of phantoms as it does");
  line.toggle("--search",
              flags.search,
              "a field of 50 x 50 mm tap by tap, each where a site proposes, instead of a pattern");
  line.choice("--rule",
              flags.rule,
              {kTapRuleNames.begin() + 1, kTapRuleNames.end()},
              "of --search: by a Gaussian process, or row by row, to compare");
  line.toggle("--session",
              flags.session,
              "whole sessions, hand, link, stage and sensor: nine taps 10 mm apart, or --search");
  line.number("--rtt-ms",
              flags.round_trip_ms,
              {.min = 0, .max = 2000, .unit = "ms"},
              "above 0: of sessions");
  line.number("--loss", flags.loss, {.min = 0, .max = 0.5}, "above 0: of sessions, each way");
  line.whole("--cores", flags.cores, {.min = 1, .max = 256}, "threads; else one a processor");
  line.report(flags.report, "palp.locate/1");
  line.output("--csv", flags.csv, "a line per case");
  plot::declare_picture(line, flags.picture, "depth, place and radius over the true depth");
}

ExitStatus run_locate(const LocateFlags& flags, const Machine& machine) {
  if (const auto agreed = agreement(flags); !agreed) return refusal(agreed.error());
  LocateStudy study = study_of(flags, machine);
  if (!flags.ball.empty()) {
    if (const auto ball = take_ball(flags.ball, study); !ball) {
      return refusal(ball.error());
    }
  }
  auto can = config::can_write_files({flags.report, flags.csv});
  if (can) can = plot::can_write_picture(flags.picture);
  if (!can) return {ExitCode::CannotOpen, "palp-lab: " + can.error().text};
  const auto bench = LocateBench::make(study);
  if (!bench) return refusal(bench.error());
  const Progress progress = shown_progress(machine);
  std::vector<LocateCase> cases(case_count(study));
  std::size_t done = 0;
  std::mutex one_at_a_time;
  machine.for_each_index(
      cases.size(), flags.cores.value_or(machine.processors), [&](std::size_t i) {
        cases[i] = bench->run(static_cast<std::uint32_t>(i));
        const std::lock_guard lock{one_at_a_time};
        if (progress) progress(++done, cases.size());
      });
  for (const auto& [path, text] : {std::pair{flags.report, locate_report(study, cases, flags.csv)},
                                   std::pair{flags.csv, locate_csv(study, cases)}}) {
    if (path.empty()) continue;
    if (const auto written = config::write_whole_file(path, text); !written) {
      return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
    }
  }
  if (const auto drawn = plot::write_picture(locate_figure(cases), flags.picture); !drawn) {
    return {ExitCode::CannotOpen, "palp-lab: " + drawn.error().text};
  }
  return {ExitCode::Done, locate_table(study, cases)};
}

}  // namespace palp::lab
