#include "study/compare_command.h"

#include <cmath>
#include <vector>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/formatted.h"
#include "study/standing.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;

struct Opened {
  PlannedStudy planned;
  std::vector<ParticipantRows> rows;
  StudyFit fit;
};

Result<Opened> open_and_fit(const std::string& folder) {
  auto planned = open_study(folder);
  if (!planned) return tl::unexpected(planned.error());
  auto rows = read_rows(*planned);
  if (!rows) return tl::unexpected(rows.error());
  StudyFit fit = fit_study(planned->study, *rows);
  if (fit.blocks.empty()) return fail(folder + " holds no answered trial: palp-study run asks");
  return Opened{std::move(*planned), std::move(*rows), std::move(fit)};
}

Json pair_json(const ConditionPair& pair, const std::vector<std::string>& names) {
  return {{"first", names[pair.first]},
          {"second", names[pair.second]},
          {"participants", pair.participants},
          {"difference_ln", pair.test.mean},
          {"difference_ln_low", pair.test.low},
          {"difference_ln_high", pair.test.high},
          {"difference_ln_sd", pair.test.sd},
          {"p", pair.test.p},
          {"p_holm", pair.p_holm},
          {"p_ranks", pair.test.p_ranks},
          {"hedges_g", pair.test.hedges_g},
          {"p_equivalent", pair.test.equivalent},
          {"group_ln", pair.group.mean},
          {"group_ln_low", pair.group.low},
          {"group_ln_high", pair.group.high},
          {"group_tau", pair.group.tau}};
}

const char* title_of(Measure measure) noexcept {
  switch (measure) {
    case Measure::Jnd:
      return "JND, second over first\n";
    case Measure::Pse:
      return "PSE (detect: criterion as a level), second less first\n";
    case Measure::Tau:
      return "Kendall's tau, second less first\n";
    case Measure::Error:
      return "error of the search, second over first\n";
    case Measure::Time:
      break;
  }
  return "time of the search, second over first\n";
}

}  // namespace

std::string pairs_text(const std::vector<ConditionPair>& pairs,
                       const std::vector<std::string>& names,
                       Measure measure) {
  std::string text = title_of(measure);
  if (pairs.empty()) {
    return text +
           "nothing to compare: no two conditions were answered to the end by two who "
           "count\n";
  }
  text +=
      "pair                        n   value  95 % interval      p (Holm)   p ranks       g  equal "
      "p\n";
  const auto cell = [](int width, int places, double value) {
    return std::isnan(value) ? formatted("%*s", width, "n/a")
                             : formatted("%*.*f", width, places, value);
  };
  for (const ConditionPair& pair : pairs) {
    const auto shown = [&](double value) { return is_ratio(measure) ? std::exp(value) : value; };
    const std::string of = names[pair.second] + " : " + names[pair.first];
    text += formatted("%-24s %4zu  ", of.c_str(), pair.participants) +
            cell(6, 3, shown(pair.test.mean)) + "  " + cell(6, 3, shown(pair.test.low)) + " to " +
            cell(-6, 3, shown(pair.test.high)) + "  " + cell(9, 4, pair.p_holm) + ' ' +
            cell(9, 4, pair.test.p_ranks) + ' ' + cell(7, 2, pair.test.hedges_g) + ' ' +
            cell(8, 4, pair.test.equivalent) + '\n';
  }
  return text;
}

ExitStatus run_fit_study(const std::string& folder, const std::string& report) {
  const auto opened = open_and_fit(folder);
  if (!opened) return config::refusal("palp-study", opened.error());
  const auto& [planned, rows, fit] = *opened;
  if (auto may = planned.data.may_write(report); !report.empty() && !may) {
    return config::refusal("palp-study", may.error());
  }
  const std::string table = fit_table(planned.study, fit, condition_codes(planned.study), true);
  const auto written = config::write_whole_file(planned.data.derived("fit.tsv"), table);
  if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  Json conditions = Json::array();
  std::string text;
  for (std::size_t i = 0; i < planned.study.conditions.size(); ++i) {
    const auto blocks = counted(fit, i);
    double mean = 0;
    for (const FittedBlock& one : blocks) mean += one.ln_jnd.mean;
    if (blocks.empty()) continue;
    mean /= static_cast<double>(blocks.size());
    conditions.push_back(Json{{"condition", condition_codes(planned.study)[i]},
                              {"participants", blocks.size()},
                              {"ln_jnd_mean", mean}});
    text += condition_text(planned.study, fit, i, condition_codes(planned.study)[i]);
  }
  for (const Exclusion& one : fit.excluded) text += one.id + " excluded: " + one.why + "\n";
  if (!report.empty()) {
    Json out{{"schema", "palp.study_fit/1"}, {"study", planned.study.name}};
    out["conditions"] = std::move(conditions);
    const auto told = config::write_whole_file(report, out.dump(2) + "\n");
    if (!told) return {ExitCode::CannotOpen, "palp-study: " + told.error().text};
  }
  return {ExitCode::Done, text};
}

void declare_compare(config::CommandLine& line, std::string& folder) {
  line.argument("FOLDER", folder, "of a study whose participants answered");
  line.required();
  line.footer("Writes derivatives/palp-study/compare.json.");
}

ExitStatus run_compare(const std::string& folder) {
  const auto opened = open_and_fit(folder);
  if (!opened) return config::refusal("palp-study", opened.error());
  const auto& [planned, rows, fit] = *opened;
  const std::vector<std::string> names = condition_codes(planned.study);
  const auto stands = standing(planned, rows);
  if (!stands) return config::refusal("palp-study", stands.error());
  Json report{{"schema", "palp.study_compare/1"},
              {"study", planned.study.name},
              {"standing", *stands},
              {"margin_ln", planned.study.margin}};
  std::string text = *stands + "\n";
  for (const Measure measure : measures_of(planned.study.task)) {
    const auto pairs = compare_study(planned.study, fit, measure);
    Json all = Json::array();
    for (const ConditionPair& pair : pairs) all.push_back(pair_json(pair, names));
    report[to_string(measure)] = std::move(all);
    text += pairs_text(pairs, names, measure);
  }
  const auto written =
      config::write_whole_file(planned.data.derived("compare.json"), report.dump(2) + "\n");
  if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  return {ExitCode::Done, text};
}

}  // namespace palp::study
