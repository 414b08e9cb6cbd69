#include "lab/report/stability_map.h"

#include <algorithm>
#include <optional>

#include <nlohmann/json.hpp>

#include "common/config/number.h"
#include "common/plot/svg_text.h"

namespace palp::lab {
namespace {

constexpr double kLeft = 54;     // [px]
constexpr double kTop = 60;      // [px]
constexpr double kAcross = 34;   // [px], a cell and its gap; "1000" fits below
constexpr double kDown = 22;     // [px]
constexpr double kBetween = 54;  // [px], between panels

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

nlohmann::ordered_json numbers(const std::vector<std::string>& texts) {
  auto list = nlohmann::ordered_json::array();
  for (const std::string& text : texts) list.push_back(config::parse_number(text).value_or(0));
  return list;
}

const char* colour_of(std::optional<bool> stable) {
  if (!stable) return "#dddddd";
  return *stable ? "#009e73" : "#d55e00";
}

}  // namespace

std::string map_report(const Plan& plan,
                       const std::vector<CaseResult>& results,
                       const BatchAccount& account) {
  using Json = nlohmann::ordered_json;
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
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
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

std::string map_svg(const std::vector<CaseResult>& results) {
  const Map map = map_of(results);
  const auto rows = static_cast<double>(map.springs.size());
  const double panel_height = kDown * rows + kBetween;
  const double width = kLeft + 20 + kAcross * static_cast<double>(map.trips.size());
  std::string text =
      plot::open_picture(width, kTop + panel_height * static_cast<double>(map.grips.size()));
  const bool open = std::count(map.stable.begin(), map.stable.end(), std::nullopt) > 0;
  plot::title(
      text,
      kLeft,
      22,
      std::string{"eq. (1): stable (green), unstable (orange)"} + (open ? ", not run (grey)" : ""));
  for (std::size_t g = 0; g < map.grips.size(); ++g) {
    const double top = kTop + panel_height * static_cast<double>(g);
    plot::label(text,
                kLeft,
                top - 8,
                "start",
                "grip " + map.grips[g] + ": k_p [N/m] over the round trip [ms]");
    for (std::size_t s = 0; s < map.springs.size(); ++s) {
      const double down = kDown * static_cast<double>(s);
      plot::label(text, kLeft - 8, top + 15 + down, "end", map.springs[s]);
      for (std::size_t t = 0; t < map.trips.size(); ++t) {
        plot::append(text,
                     "<rect x=\"%.0f\" y=\"%.0f\" width=\"32\" height=\"20\" fill=\"%s\"/>\n",
                     kLeft + kAcross * static_cast<double>(t),
                     top + down,
                     colour_of(map.at(g, s, t)));
      }
    }
    for (std::size_t t = 0; t < map.trips.size(); ++t) {
      plot::label(text,
                  kLeft + 16 + kAcross * static_cast<double>(t),
                  top + kDown * rows + 14,
                  "middle",
                  map.trips[t]);
    }
  }
  return text + "</svg>\n";
}

}  // namespace palp::lab
