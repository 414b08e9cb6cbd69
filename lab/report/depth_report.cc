#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "common/config/json.h"
#include "common/core/conventions.h"
#include "common/core/median.h"
#include "lab/plan/depth_study.h"
#include "lab/report/depth_cases.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

using config::Json;

constexpr std::size_t kDepthRows = 3;
constexpr double kNear = 0.2;  // of the depth: an answer worth having
constexpr double kStrong = 5;  // standard deviations: such a signal must be found

/// Cases of one depth, or of one third of the range.
struct DepthRow {
  Knowledge knowledge{Knowledge::Range};
  bool wide{};
  double depth{};  ///< [m], mean of the truth
  std::vector<const DepthCase*> cases;
};

struct RowFigures {
  std::size_t found{};
  std::size_t inside{};
  std::size_t inside_open{};  ///< an end that is the end of what was assumed holds what is beyond
  double rmse{};              ///< [m]
  double bias{};              ///< [m]
  double median{};            ///< [m], of the absolute error
  double bound{};             ///< [m], root mean square
  double claimed{};           ///< [m], root mean square of the estimator's own standard deviation
  double width{};             ///< [m], mean of the intervals
  double bound_width{};       ///< [m], of the bound's
};

/// Random phantoms: thirds of the depths, drawn from the prior and wider. Listed depths: each, with
/// one knowledge and then with the other.
std::vector<DepthRow> rows_of(const DepthStudy& study, const std::vector<DepthCase>& cases) {
  const bool random = study.depths.empty();
  const std::size_t depths = random ? kDepthRows : study.depths.size();
  std::vector<DepthRow> rows(2 * depths);
  for (const DepthCase& one : cases) {
    if (!one.inclusion) continue;
    const bool second = random ? one.wide : one.knowledge == Knowledge::Range;
    const std::size_t place =
        random ? static_cast<std::size_t>(std::clamp((one.depth - 4e-3) / 7e-3, 0.0, 2.0))
               : one.index / study.repeats % depths;
    DepthRow& row = rows[place + (second ? depths : 0)];
    row.knowledge = one.knowledge;
    row.wide = one.wide;
    row.cases.push_back(&one);
    row.depth += one.depth;
  }
  std::erase_if(rows, [](const DepthRow& row) { return row.cases.empty(); });
  for (DepthRow& row : rows) row.depth /= static_cast<double>(row.cases.size());
  return rows;
}

RowFigures figures(const std::vector<const DepthCase*>& cases) {
  RowFigures out;
  std::vector<double> errors;
  for (const DepthCase* one : cases) {
    if (one->verdict != DepthVerdict::Found) continue;
    ++out.found;
    const double error = one->estimate - one->depth;
    errors.push_back(std::abs(error));
    out.bias += error;
    out.rmse += error * error;
    out.bound += one->bound * one->bound;
    out.claimed += one->stddev * one->stddev;
    out.width += one->high - one->low;
    out.bound_width += 2 * 1.96 * one->bound;
    const bool above = one->depth < one->low;
    const bool below = one->depth > one->high;
    out.inside += above || below ? 0 : 1;
    const bool missed = (above && one->low > one->assumed_low) ||  //
                        (below && one->high < one->assumed_high);
    out.inside_open += missed ? 0 : 1;
  }
  if (out.found == 0) return out;
  const auto n = static_cast<double>(out.found);
  out.bias /= n;
  out.rmse = std::sqrt(out.rmse / n);
  out.bound = std::sqrt(out.bound / n);
  out.claimed = std::sqrt(out.claimed / n);
  out.width /= n;
  out.bound_width /= n;
  out.median = median(errors).value_or(0);
  return out;
}

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

Json number(std::optional<double> value) { return value ? Json(*value) : Json(nullptr); }

/// Of all depths together.
struct Totals {
  std::size_t plain{};
  std::size_t false_alarms{};
  double excluded{};  ///< [m], mean over plain phantoms in which nothing was found
  std::size_t strong{};
  std::size_t strong_found{};
  RowFigures all;
  RowFigures near;  ///< where the bound is below kNear of the depth
  RowFigures wide;
  std::size_t wide_count{};
};

Totals totals(const std::vector<DepthCase>& cases) {
  Totals out;
  std::vector<const DepthCase*> with;
  std::vector<const DepthCase*> near;
  std::vector<const DepthCase*> wide;
  for (const DepthCase& one : cases) {
    const bool found = one.verdict == DepthVerdict::Found;
    if (!one.inclusion) {
      ++out.plain;
      out.false_alarms += found ? 1 : 0;
      out.excluded += one.excluded;
      continue;
    }
    if (one.wide) {
      wide.push_back(&one);
      continue;
    }
    with.push_back(&one);
    if (one.bound < kNear * one.depth) near.push_back(&one);
    if (one.signal < kStrong) continue;
    ++out.strong;
    out.strong_found += found ? 1 : 0;
  }
  if (out.plain > out.false_alarms) {
    out.excluded /= static_cast<double>(out.plain - out.false_alarms);
  }
  out.all = figures(with);
  out.near = figures(near);
  out.wide = figures(wide);
  out.wide_count = wide.size();
  return out;
}

std::string text(const char* name, std::optional<double> value, double scale, const char* unit) {
  if (!value) return std::string{name} + " -\n";
  char line[128];
  std::snprintf(line, sizeof line, "%s %.4g%s\n", name, *value * scale, unit);
  return line;
}

Json row_json(const DepthRow& row) {
  const RowFigures f = figures(row.cases);
  Json one;
  one["prior"] = std::string{to_string(row.knowledge)};
  one["wide"] = row.wide;
  one["depth_mm"] = row.depth / kMillimetre;
  one["n"] = row.cases.size();
  one["rmse_mm"] = f.rmse / kMillimetre;
  one["bias_mm"] = f.bias / kMillimetre;
  one["median_abs_mm"] = f.median / kMillimetre;
  one["crb_mm"] = f.bound / kMillimetre;
  one["stddev_mm"] = f.claimed / kMillimetre;
  one["coverage95"] = number(share(f.inside, f.found));
  one["width_mean_mm"] = f.width / kMillimetre;
  one["width_bound_mm"] = f.bound_width / kMillimetre;
  one["found"] = number(share(f.found, row.cases.size()));
  return one;
}

std::string row_text(const DepthRow& row) {
  const RowFigures f = figures(row.cases);
  char line[200];
  std::snprintf(line,
                sizeof line,
                "%-6s %8.2f %5zu %5.1f %% %8.3f %7.2f %8.3f %7.3f %8.3f %7.1f %% %9.3f %9.3f\n",
                row.wide ? "wide" : to_string(row.knowledge).data(),
                row.depth / kMillimetre,
                row.cases.size(),
                100 * share(f.found, row.cases.size()).value_or(0),
                f.rmse / kMillimetre,
                row.depth > 0 ? 100 * f.rmse / row.depth : 0,
                f.bias / kMillimetre,
                f.bound / kMillimetre,
                f.claimed / kMillimetre,
                100 * share(f.inside, f.found).value_or(0),
                f.width / kMillimetre,
                f.bound_width / kMillimetre);
  return line;
}

}  // namespace

std::string depth_report(const DepthStudy& study,
                         const std::vector<DepthCase>& cases,
                         const std::string& cases_csv) {
  Json json;
  json["schema"] = "palp.depth/1";
  json["estimator"] = std::string{to_string(study.estimator)};
  json["count"] = case_count(study);
  json["seed"] = study.seed;
  json["taps_per_phantom"] = study.taps;
  json["reference_taps"] = study.reference_taps;
  json["rtt_ms"] = study.round_trip * 1e3;
  json["loss"] = study.loss;
  json["digest"] = hexadecimal(digest_of(cases));
  json["rows"] = Json::array();
  for (const DepthRow& row : rows_of(study, cases)) json["rows"].push_back(row_json(row));
  const Totals all = totals(cases);
  json["coverage95"] = number(share(all.all.inside, all.all.found));
  json["plain_count"] = all.plain;
  json["false_alarm_rate"] = number(share(all.false_alarms, all.plain));
  json["excluded_mean_mm"] =
      all.plain > all.false_alarms ? Json(all.excluded / kMillimetre) : Json();
  json["power"] = number(share(all.strong_found, all.strong));
  json["power_count"] = all.strong;
  Json& near = json["near_the_limit"];
  near["n"] = all.near.found;
  near["rmse_mm"] = all.near.rmse / kMillimetre;
  near["crb_mm"] = all.near.bound / kMillimetre;
  json["wide_count"] = all.wide_count;
  json["wide_coverage95"] = number(share(all.wide.inside, all.wide.found));
  json["wide_coverage95_open"] = number(share(all.wide.inside_open, all.wide.found));
  json["cases_csv"] = cases_csv.empty() ? Json(nullptr) : Json(cases_csv);
  // A file's name need not be UTF-8.
  return json.dump(2) + "\n";
}

std::string depth_table(const DepthStudy& study, const std::vector<DepthCase>& cases) {
  std::string out =
      "prior  depth mm     n   found  rmse mm  rmse %  bias mm  crb mm  claimed  coverage  width "
      "mm (bound's)\n";
  for (const DepthRow& row : rows_of(study, cases)) out += row_text(row);
  const Totals all = totals(cases);
  if (!study.depths.empty()) {
    if (study.estimator == depth::EstimatorKind::Bayes) {
      out += "ball: radius 15 mm and ratio 856 known exactly; range: 3 to 16 mm, 3 to 900\n";
    }
    return out;
  }
  out += text("coverage of the 95 % intervals", share(all.all.inside, all.all.found), 100, " %");
  if (all.near.found > 0) {
    out += text("rmse over bound, where the bound is below a fifth of the depth",
                all.near.rmse / all.near.bound,
                1,
                "");
  }
  out += text("false alarms", share(all.false_alarms, all.plain), 100, " % of plain phantoms");
  if (all.plain > all.false_alarms) {
    out += text("plain phantoms: no inclusion of radius >= 5 mm above",
                all.excluded,
                1 / kMillimetre,
                " mm on average");
  }
  out += text("found above 5 sigma", share(all.strong_found, all.strong), 100, " %");
  out += text("coverage over phantoms wider than the prior",
              share(all.wide.inside, all.wide.found),
              100,
              " %");
  out += text("the same, where an end of what was assumed means 'or beyond'",
              share(all.wide.inside_open, all.wide.found),
              100,
              " %");
  return out;
}

std::string depth_csv(const std::vector<DepthCase>& cases) {
  std::string out =
      "index,inclusion,wide,prior,depth_mm,radius_mm,ratio,scale,verdict,estimate_mm,low_mm,high_"
      "mm,h_n,"
      "crb_mm,signal_sigma,indentation_max_mm,strokes\n";
  for (const DepthCase& one : cases) {
    char line[320];
    std::snprintf(line,
                  sizeof line,
                  "%u,%d,%d,%s,%.9g,%.9g,%.9g,%.9g,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%u\n",
                  one.index,
                  one.inclusion ? 1 : 0,
                  one.wide ? 1 : 0,
                  std::string{to_string(one.knowledge)}.c_str(),
                  one.depth / kMillimetre,
                  one.radius / kMillimetre,
                  one.ratio,
                  one.scale,
                  std::string{to_string(one.verdict)}.c_str(),
                  one.estimate / kMillimetre,
                  one.low / kMillimetre,
                  one.high / kMillimetre,
                  one.hash,
                  one.bound / kMillimetre,
                  one.signal,
                  one.indentation / kMillimetre,
                  one.strokes);
    out += line;
  }
  return out;
}

}  // namespace palp::lab
