#include "study/compare_command.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "common/config/json.h"
#include "common/config/report.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;

struct Opened {
  PlannedStudy planned;
  StudyFit fit;
};

Result<Opened> open_and_fit(const std::string& folder) {
  auto planned = open_study(folder);
  if (!planned) return tl::unexpected(planned.error());
  const auto rows = read_rows(*planned);
  if (!rows) return tl::unexpected(rows.error());
  StudyFit fit = fit_study(planned->study, *rows);
  if (fit.blocks.empty()) return fail(folder + " holds no answered trial: palp-study run asks");
  return Opened{std::move(*planned), std::move(fit)};
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

std::string standing(const PlannedStudy& planned, const StudyFit& fit) {
  if (!planned.registered) return "exploratory: " + planned.why_not;
  if (fit.participants < planned.study.participants) {
    return "exploratory: " + std::to_string(fit.participants) + " of " +
           std::to_string(planned.study.participants) + " registered participants";
  }
  return "confirmatory: study file and schedule are those that were registered";
}

std::string pairs_text(const std::vector<ConditionPair>& pairs,
                       const std::vector<std::string>& names,
                       Measure measure) {
  std::string text = title_of(measure);
  text +=
      "pair                        n   value  95 % interval      p (Holm)   p ranks       g  equal "
      "p\n";
  for (const ConditionPair& pair : pairs) {
    const auto shown = [&](double value) { return is_ratio(measure) ? std::exp(value) : value; };
    const std::string of = names[pair.second] + " : " + names[pair.first];
    std::array<char, 256> line{};
    std::snprintf(line.data(),
                  line.size(),
                  "%-24s %4zu  %6.3f  %6.3f to %-6.3f  %9.4f %9.4f %7.2f %8.4f\n",
                  of.c_str(),
                  pair.participants,
                  shown(pair.test.mean),
                  shown(pair.test.low),
                  shown(pair.test.high),
                  pair.p_holm,
                  pair.test.p_ranks,
                  pair.test.hedges_g,
                  pair.test.equivalent);
    text += line.data();
  }
  return text;
}

ExitStatus run_fit_study(const std::string& folder, const std::string& report) {
  const auto opened = open_and_fit(folder);
  if (!opened) return config::refusal("palp-study", opened.error());
  const auto& [planned, fit] = *opened;
  const std::string table = fit_table(planned.study, fit, condition_codes(planned.study));
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
  const auto& [planned, fit] = *opened;
  const std::vector<std::string> names = condition_codes(planned.study);
  Json report{{"schema", "palp.study_compare/1"},
              {"study", planned.study.name},
              {"standing", standing(planned, fit)},
              {"margin_ln", planned.study.margin}};
  std::string text = standing(planned, fit) + "\n";
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
