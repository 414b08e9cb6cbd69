#include "lab/report/stability_map.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/config/json.h"
#include "common/config/number.h"

namespace palp::lab {
namespace {

constexpr std::size_t kRowName = 20;  ///< [characters]

/// All cells of the map, in the order of its plan.
struct Map {
  std::vector<std::string> grips;
  std::vector<std::string> springs;
  std::vector<std::string> trips;
  std::vector<std::optional<bool>> stable;  ///< by grip, spring, trip; none: not run

  [[nodiscard]] std::optional<bool> at(std::size_t g, std::size_t s, std::size_t t) const {
    return stable[(g * springs.size() + s) * trips.size() + t];
  }
};

Map map_of(const std::vector<CaseResult>& results) {
  const Plan whole = make_map({});
  const auto column = [&](const char* name) {
    const auto found = std::find(whole.label_names.begin(), whole.label_names.end(), name);
    return static_cast<std::size_t>(found - whole.label_names.begin());
  };
  const auto add = [](std::vector<std::string>& list, const std::string& value) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
  };
  Map map;
  for (const Case& one : whole.cases) {
    add(map.grips, one.labels[column("grip")]);
    add(map.springs, one.labels[column("k_p_n_per_m")]);
    add(map.trips, one.labels[column("rtt_ms")]);
  }
  map.stable.resize(whole.cases.size());
  for (const CaseResult& result : results) {
    if (result.index < map.stable.size()) map.stable[result.index] = !result.unstable;
  }
  return map;
}

using config::Json;

Json numbers(const std::vector<std::string>& texts) {
  auto list = Json::array();
  for (const std::string& text : texts) list.push_back(config::parse_number(text).value_or(0));
  return list;
}

/// The cells of a grip that are as `state` says.
plot::Curve cells_where(const Map& map, std::size_t grip, std::optional<bool> state) {
  plot::Curve cells{.mark = plot::Mark::Cells};
  for (std::size_t s = 0; s < map.springs.size(); ++s) {
    for (std::size_t t = 0; t < map.trips.size(); ++t) {
      if (map.at(grip, s, t) != state) continue;
      cells.x.push_back(static_cast<double>(t));
      cells.y.push_back(static_cast<double>(s));
    }
  }
  return cells;
}

}  // namespace

std::string map_report(const Plan& plan,
                       const std::vector<CaseResult>& results,
                       const BatchAccount& account) {
  const Map map = map_of(results);
  Json json;
  json["schema"] = "palp.map/1";
  json["seed"] = plan.seed;
  json["tissue"] = plan.tissue;
  json["shard"] = account.shard.empty() ? Json(nullptr) : Json(account.shard);
  json["grips"] = map.grips;
  json["k_p_n_per_m"] = numbers(map.springs);
  json["rtt_ms"] = numbers(map.trips);
  Json stable = Json::array();
  for (std::size_t g = 0; g < map.grips.size(); ++g) {
    for (std::size_t s = 0; s < map.springs.size(); ++s) {
      for (std::size_t t = 0; t < map.trips.size(); ++t) {
        const auto cell = map.at(g, s, t);
        stable[g][s][t] = cell ? Json(*cell) : Json(nullptr);
      }
    }
  }
  json["stable"] = stable;
  const bool merged = account.cores == 0;
  json["cores"] = merged ? Json(nullptr) : Json(account.cores);
  json["cpu_s"] = merged ? Json(nullptr) : Json(account.cpu);
  json["wall_s"] = merged ? Json(nullptr) : Json(account.wall);
  return json.dump(2) + "\n";
}

std::string map_text(const std::vector<CaseResult>& results) {
  const Map map = map_of(results);
  std::string text;
  for (std::size_t g = 0; g < map.grips.size(); ++g) {
    for (std::size_t s = 0; s < map.springs.size(); ++s) {
      std::string name = map.grips[g] + " k_p " + map.springs[s];
      name.resize(kRowName, ' ');
      text += name;
      for (std::size_t t = 0; t < map.trips.size(); ++t) {
        const auto cell = map.at(g, s, t);
        text += cell ? (*cell ? " S" : " .") : " ?";
      }
      text += '\n';
    }
  }
  return text;
}

plot::Figure map_figure(const std::vector<CaseResult>& results) {
  const Map map = map_of(results);
  const bool open = std::count(map.stable.begin(), map.stable.end(), std::nullopt) > 0;
  plot::Figure figure{.title = "Stability of eq. (1)"};
  for (std::size_t g = 0; g < map.grips.size(); ++g) {
    const bool first = g == 0;  // its legend is that of all
    const bool last = g + 1 == map.grips.size();
    std::vector<plot::Curve> kinds{
        cells_where(map, g, true), cells_where(map, g, false), cells_where(map, g, std::nullopt)};
    kinds[0].colour = plot::kBlue;
    kinds[1].colour = plot::kOrange;
    kinds[2].colour = plot::kGrey;
    if (first) {
      kinds[0].name = "stable";
      kinds[1].name = "unstable";
      kinds[2].name = open ? "not run" : "";
    }
    figure.panels.push_back({.axes = {.title = "grip " + map.grips[g],
                                      .x_name = last ? "round trip [ms]" : "",
                                      .y_name = "k_p [N/m]",
                                      .x_classes = map.trips,
                                      .y_classes = map.springs},
                             .curves = std::move(kinds)});
  }
  return figure;
}

}  // namespace palp::lab
