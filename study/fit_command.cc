#include "study/fit_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/formatted.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "study/answer_posterior.h"
#include "study/compare_command.h"
#include "study/curve_fit.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;

constexpr std::array kShapes{CurveShape::Normal, CurveShape::Logistic, CurveShape::Weibull};

/// What one condition shows.
struct Row {
  std::string condition;
  std::size_t trials{};
  std::size_t yes{};
  Marginal ln_jnd;
  Marginal pse;
  double lapse{};  // [-], mean
  std::optional<CurveFit> curve;
};

/// The posterior does not depend on which levels a method could have asked.
AnswerPosterior posterior_of(const AnswerTable& table, std::span<const Answers> answers) {
  AnswerPosterior posterior{table};
  for (std::size_t level = 0; level < answers.size(); ++level) {
    for (std::size_t i = 0; i < answers[level].trials; ++i) {
      posterior.told(level, i < answers[level].yes);
    }
  }
  return posterior;
}

Result<Row> row_of(const ConditionAnswers& of, const Task& task, const FitFlags& flags) {
  std::vector<double> levels;
  Row row;
  row.condition = of.condition;
  if (std::ranges::all_of(of.answers, [](const Answers& at) { return at.level == 0; })) {
    return fail("every level is 0: nothing was there to be told apart");
  }
  for (const Answers& at : of.answers) {
    if (!task.two_sided && at.level < 0) {
      return fail("a level below 0 is of a two-sided task: add --two-sided");
    }
    levels.push_back(at.level);
    row.trials += at.trials;
    row.yes += at.yes;
  }
  const AnswerTable table{task, {}, {.jnd_count = 161}, std::move(levels)};
  const AnswerPosterior posterior = posterior_of(table, of.answers);
  row.ln_jnd = posterior.ln_jnd();
  row.pse = posterior.pse();
  row.lapse = posterior.lapse_mean();
  if (flags.curve.empty()) return row;
  CurveFitOptions options{
      .shape = *std::ranges::find(kShapes,
                                  std::string_view{flags.curve},
                                  [](CurveShape shape) { return to_string(shape); }),
      .intervals = task.two_sided ? 1 : task.intervals};
  auto fit = fit_curve(of.answers, options);
  if (!fit) return tl::unexpected(fit.error());
  row.curve = *fit;
  return row;
}

Json estimate_json(const CurveEstimate& estimate) {
  return {{"likeliest", estimate.likeliest},
          {"mean", estimate.mean},
          {"low", estimate.low},
          {"high", estimate.high}};
}

Json row_json(const Row& row, const Task& task) {
  Json out{{"condition", row.condition},
           {"trials", row.trials},
           {"yes", row.yes},
           {"ln_jnd_mean", row.ln_jnd.mean},
           {"ln_jnd_sd", row.ln_jnd.sd},
           {"lapse_mean", row.lapse}};
  const std::string jnd = "jnd_" + level_suffix(task);
  out[jnd] = std::exp(row.ln_jnd.median);
  out[jnd + "_low"] = std::exp(row.ln_jnd.low);
  out[jnd + "_high"] = std::exp(row.ln_jnd.high);
  if (task.two_sided) {
    out["pse_ln"] = row.pse.median;
    out["pse_ln_low"] = row.pse.low;
    out["pse_ln_high"] = row.pse.high;
  }
  if (row.curve) {
    out["threshold"] = estimate_json(row.curve->threshold);
    out["width"] = estimate_json(row.curve->width);
    out["lapse"] = estimate_json(row.curve->lapse);
    out["guess"] = estimate_json(row.curve->guess);
    out["dispersion"] = estimate_json(row.curve->dispersion);
    out["deviance"] = row.curve->deviance;
  }
  return out;
}

std::string row_text(const Row& row, const Task& task) {
  std::string text =
      formatted("%-24s  %6zu  %6.1f  %8.1f  %6.1f to %-6.1f  %6.1f",
                harmless_line(row.condition.empty() ? "all" : row.condition).c_str(),
                row.trials,
                100.0 * static_cast<double>(row.yes) / static_cast<double>(row.trials),
                said_level(task, std::exp(row.ln_jnd.median)),
                said_level(task, std::exp(row.ln_jnd.low)),
                said_level(task, std::exp(row.ln_jnd.high)),
                100 * row.lapse);
  if (task.two_sided) {
    text += formatted("  %8.1f  %6.1f to %-6.1f",
                      percent_of_level(row.pse.median),
                      percent_of_level(row.pse.low),
                      percent_of_level(row.pse.high));
  }
  if (row.curve) {
    text += formatted("  %9.4f  %7.4f to %-7.4f  %8.4f",
                      row.curve->threshold.likeliest,
                      row.curve->threshold.low,
                      row.curve->threshold.high,
                      row.curve->width.likeliest);
  }
  return text + "\n";
}

std::string header_text(const Task& task, bool curve) {
  std::string text = "condition                 trials   right       JND  95 % interval     lapse";
  if (task.two_sided) text += "      bias  95 % interval   ";
  if (curve) text += "  threshold  95 % interval          width";
  text += task.delays
              ? "\n                                       %        ms              ms       %"
              : "\n                                       %         %               %       %";
  if (task.two_sided) text += "         %               %   ";
  if (curve) {
    text += task.delays ? "         ms               ms         ms"
                        : "         ln               ln         ln";
  }
  return text + "\n";
}

}  // namespace

void declare_fit(config::CommandLine& line, FitFlags& flags) {
  line.argument("FILE",
                flags.file,
                "trials, tab-separated: level_ln or level_ms, correct; condition, trial_type if "
                "wanted; or the "
                "folder of a study, whose fit.tsv is written");
  line.required();
  line.whole("--intervals",
             flags.intervals,
             {.min = 2, .max = 8},
             "of the forced choice; one holds the stronger stimulus");
  line.toggle("--two-sided",
              flags.two_sided,
              "levels of both signs, answers \"the second is stiffer\": finds a bias as well");
  line.choice("--curve",
              flags.curve,
              {"normal", "logistic", "weibull"},
              "also fit a curve of free width, as psignifit 4 does");
  line.report(flags.report, "palp.study_fit/1");
}

Result<FitStatement> fit_statement(const AnswersFile& file, const FitFlags& flags) {
  const Task task{.intervals = static_cast<int>(flags.intervals),
                  .two_sided = flags.two_sided,
                  .delays = file.delays};
  if (task.delays && task.two_sided) return fail("--two-sided is of levels in level_ln");
  FitStatement out{.text = header_text(task, !flags.curve.empty()), .report = {}};
  Json report{{"schema", "palp.study_fit/1"},
              {"intervals", flags.intervals},
              {"two_sided", flags.two_sided},
              {"curve", flags.curve}};
  report["conditions"] = Json::array();
  for (const ConditionAnswers& one : file.conditions) {
    const auto row = row_of(one, task, flags);
    if (!row) {
      return one.condition.empty()
                 ? fail(row.error().text)
                 : fail("condition '" + printable(one.condition) + "'", row.error());
    }
    out.text += row_text(*row, task);
    report["conditions"].push_back(row_json(*row, task));
  }
  out.report = report.dump(2) + "\n";
  return out;
}

ExitStatus run_fit(const FitFlags& flags) {
  std::error_code ignored;
  if (std::filesystem::is_directory(flags.file, ignored)) {
    if (flags.two_sided || !flags.curve.empty() || flags.intervals != FitFlags{}.intervals) {
      return {ExitCode::BadInput,
              "palp-study: --intervals, --two-sided and --curve are of tables; a study's folder "
              "says itself what was asked"};
    }
    return run_fit_study(flags.file, flags.report);
  }
  const auto text = read_whole_file(flags.file, std::size_t{64} << 20);
  if (!text) return config::refusal("palp-study", text.error());
  const auto file = parse_answers(*text, flags.file);
  if (!file) return config::refusal("palp-study", file.error());
  const auto statement = fit_statement(*file, flags);
  if (!statement) return config::refusal("palp-study", statement.error());
  if (!flags.report.empty()) {
    const auto written = config::write_whole_file(flags.report, statement->report);
    if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  }
  return {ExitCode::Done, statement->text};
}

}  // namespace palp::study
