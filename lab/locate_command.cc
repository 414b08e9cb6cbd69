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
}  // namespace

void declare_locate(config::CommandLine& line, LocateFlags& flags) {
  line.whole("--count", flags.count, {.min = 1, .max = 100'000}, "random phantoms, and plain ones");
  line.whole("--seed", flags.seed, {.min = 0, .max = 9007199254740991}, "of everything random");
  line.whole("--rows", flags.rows, {.min = 2, .max = 10}, "of the pattern, and as many columns");
  line.number(
      "--pitch-mm", flags.pitch_mm, {.min = 2, .max = 30, .unit = "mm"}, "between the places");
  line.number("--stiffness-spread",
              flags.spread,
              {.min = 0, .max = 0.3},
              "share by which the tissue's stiffness varies from place to place");
  line.number("--stiffness-length-mm",
              flags.length_mm,
              {.min = 0, .max = 200, .unit = "mm"},
              "over which it varies; 0: anew at each place of a pattern");
  line.number("--assumed-spread",
              flags.assumed_spread,
              {.min = 0, .max = 0.3},
              "what the estimator assumes of that");
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
  line.choice("--next-tap",
              flags.rule,
              {kTapRuleNames.begin(), kTapRuleNames.end()},
              "a field of 50 x 50 mm tap by tap: as a site proposes, by a Gaussian process, or row "
              "by row");
  line.choice("--session",
              flags.script,
              {"map", "search"},
              "whole sessions: a hand taps nine places, or searches");
  line.number(
      "--rtt-ms", flags.round_trip_ms, {.min = 0, .max = 2000, .unit = "ms"}, "of sessions");
  line.number("--loss", flags.loss, {.min = 0, .max = 0.5}, "of sessions, each way");
  line.whole("--cores", flags.cores, {.min = 1, .max = 256}, "threads at a time");
  line.report(flags.report, "palp.locate/1");
  line.output("--csv", flags.csv, "a line per case");
  plot::declare_picture(line, flags.picture, "depth, place and radius over the true depth");
}

ExitStatus run_locate(const LocateFlags& flags, const Machine& machine) {
  LocateStudy study{.count = static_cast<std::uint32_t>(flags.count),
                    .seed = flags.seed,
                    .rows = static_cast<std::uint32_t>(flags.rows),
                    .pitch = flags.pitch_mm * kMillimetre,
                    .spread = flags.spread,
                    .length = flags.length_mm * kMillimetre,
                    .assumed_spread = flags.assumed_spread,
                    .depth_max = flags.depth_max_mm * kMillimetre,
                    .mismatch = flags.set == "mismatch",
                    .script = flags.script,
                    .round_trip = 1e-3 * flags.round_trip_ms,
                    .loss = flags.loss};
  for (std::size_t i = 0; i < kTapRuleNames.size(); ++i) {
    if (flags.rule == kTapRuleNames[i]) study.rule = static_cast<TapRule>(i);
  }
  if (study.rule && (study.mismatch || !study.script.empty())) {
    const Result<void> both = fail("--next-tap goes neither with --set nor with --session");
    return refusal(both.error());
  }
  const bool pattern = !study.rule && study.script.empty();
  if (flags.length_mm < kLengthLeastMm && !(pattern && flags.length_mm == 0)) {
    const Result<void> short_length =
        fail("--stiffness-length-mm is 2 or more, or 0 where the places are those of a pattern");
    return refusal(short_length.error());
  }
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
      cases.size(), flags.cores > 0 ? flags.cores : machine.processors, [&](std::size_t i) {
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
