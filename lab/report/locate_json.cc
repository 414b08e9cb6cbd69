#include <utility>

#include "common/config/json.h"
#include "common/core/conventions.h"
#include "common/core/median.h"
#include "lab/plan/locate_study.h"
#include "lab/report/locate_figures.h"

namespace palp::lab {
namespace {

using config::Json;

constexpr std::array<const char*, kLocated> kCoordinates{"x", "y", "depth", "radius", "ratio"};

/// Null where nobody measured.
Json number_if(bool told, double value) { return told ? Json(value) : Json(nullptr); }

/// Adds what was found of some balls, and how well.
void add_figures(const LocateStudy& study, const LocateFigures& f, Json& out) {
  out["n"] = f.count;
  out["found"] = f.found;
  out["trusted"] = f.trusted;
  for (std::size_t i = 0; i < kLocated; ++i) {
    const bool told = f.found > 0 && tells(study, i);
    out["coverage95"][kCoordinates[i]] = number_if(told, share_or_zero(f.inside[i], f.found));
    if (i + 1 == kLocated) continue;
    out["rmse_mm"][kCoordinates[i]] = number_if(told, f.rmse[i] / kMillimetre);
    out["over_bound"][kCoordinates[i]] =
        f.bounds[i] > 0 ? Json(f.rmse[i] / f.bounds[i]) : Json(nullptr);
  }
}

Json cell_json(const LocateStudy& study, const LocateCell& cell) {
  Json out;
  for (const auto& [name, range] :
       {std::pair{"radius_mm", cell.radius}, std::pair{"depth_mm", cell.depth}}) {
    out[name] = Json::array();
    for (const double border : range) out[name].push_back(border / kMillimetre);
  }
  add_figures(study, cell.figures, out);
  return out;
}

/// How long the answer took once the last tap was over.
Json update_json(const std::vector<LocateCase>& cases) {
  std::vector<double> spans;
  double most = 0;
  for (const LocateCase& one : cases) {
    if (one.update <= 0) continue;
    spans.push_back(1e3 * one.update);
    most = std::max(most, spans.back());
  }
  Json out;
  out["p50"] = number_if(!spans.empty(), median(spans).value_or(0));
  out["max"] = number_if(!spans.empty(), most);
  return out;
}

}  // namespace

std::string locate_report(const LocateStudy& study,
                          const std::vector<LocateCase>& cases,
                          const std::string& cases_csv) {
  Json json;
  json["schema"] = "palp.locate/1";
  json["count"] = study.count;
  json["seed"] = study.seed;
  json["taps"] = study.rows * study.rows;
  json["pitch_mm"] = study.pitch / kMillimetre;
  json["heterogeneity"] = study.spread;
  json["heterogeneity_length_mm"] = study.length / kMillimetre;
  json["assumed_spread"] = study.assumed_spread;
  json["e_kpa"] = study.modulus / 1e3;
  json["told_kpa"] = study.told / 1e3;
  json["depth_max_mm"] = study.depth_max / kMillimetre;
  json["set"] = study.mismatch ? Json("mismatch") : Json(nullptr);
  json["search"] =
      study.rule ? Json(kTapRuleNames[static_cast<std::size_t>(*study.rule)]) : Json(nullptr);
  json["session"] = study.script.empty() ? Json(nullptr) : Json(study.script);
  json["rtt_ms"] = study.round_trip * 1e3;
  json["loss"] = study.loss;
  add_figures(study, figures_of_all(cases), json);
  json["right"] = right_of(cases);
  json["cells"] = Json::array();
  for (const LocateCell& cell : cells_of(study, cases)) {
    json["cells"].push_back(cell_json(study, cell));
  }
  json["rows"] = Json::array();
  for (const LocateRow& row : rows_of(study, cases)) {
    Json one;
    one["balls"] = row.name;
    add_figures(study, row.figures, one);
    json["rows"].push_back(std::move(one));
  }
  for (const auto& [name, number] :
       {std::pair{"taps_to_1mm", &Searched::known}, std::pair{"taps_to_place", &Searched::near}}) {
    for (const auto& [quantile, share] : {std::pair{"p50", 0.5}, std::pair{"p90", 0.9}}) {
      const double taps = study.rule ? touches_of(cases, number, share) : 0;
      json[name][quantile] = number_if(taps > 0, taps);
    }
  }
  json["strokes_p50"] = number_if(!study.script.empty(), strokes_of(cases));
  json["kinds"] = Json::array();
  for (const LocateWorlds& one : study.mismatch ? worlds_of(cases) : std::vector<LocateWorlds>{}) {
    json["kinds"].push_back({{"kind", one.name},
                             {"n", one.count},
                             {"confident_wrong", one.wrong},
                             {"warned", one.warned},
                             {"plain_found", one.alarms}});
  }
  const LocateAlarms told = alarms(cases);
  json["plain_count"] = told.plain;
  json["false_alarm_rate"] = share_or_zero(told.found, told.plain);
  json["not_trusted_rate"] = share_or_zero(told.doubted, told.all);
  json["model_doubted_rate"] = share_or_zero(told.model, told.all);
  json["update_ms"] = update_json(cases);
  json["cases_csv"] = cases_csv.empty() ? Json(nullptr) : Json(cases_csv);
  return json.dump(2) + "\n";
}

}  // namespace palp::lab
