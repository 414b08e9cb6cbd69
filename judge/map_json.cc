#include "judge/map_json.h"

#include <string>
#include <utility>

#include "common/core/conventions.h"
#include "common/message/map_text.h"

namespace palp::judge {
namespace {

using config::Json;

Json verdict_of(const MapReport& map) {
  const bool found = map.verdict == DepthVerdict::Found;
  return found && !map.trusted() ? "not_trusted" : std::string{to_string(map.verdict)};
}

Json doubts_json(MapDoubts doubts) {
  Json list = Json::array();
  for (std::size_t i = 0; i < kMapDoubts; ++i) {
    const auto one = static_cast<MapDoubt>(i);
    if ((doubts & doubts_of(one)) == 0) continue;
    list.push_back({{"reason", reason_of(one)}, {"remedy", remedy_of(one)}});
  }
  return list;
}

}  // namespace

Json map_json(const MapReport& map, const std::vector<MapCell>& cells) {
  if (map.number == 0) return nullptr;
  Json json;
  json["verdict"] = verdict_of(map);
  json["places"] = map.places;
  const bool found = map.verdict == DepthVerdict::Found;
  for (const auto& [name, one] : {std::pair{"x", &map.x},
                                  std::pair{"y", &map.y},
                                  std::pair{"depth", &map.depth},
                                  std::pair{"radius", &map.radius}}) {
    const auto put = [&, part = std::string{name}](const char* what, double metres) {
      json[part + what] = found ? Json(metres / kMillimetre) : Json(nullptr);
    };
    put("_mm", one->median);
    put("_low_mm", one->low);
    put("_high_mm", one->high);
  }
  json["log_odds"] = map.log_odds;
  json["place_spread"] = map.place_spread;
  json["doubts"] = doubts_json(map.doubts);
  json["next"] = {{"x_mm", map.next.x / kMillimetre},
                  {"y_mm", map.next.y / kMillimetre},
                  {"gain_nat", map.next_gain}};
  json["enough"] = map.stop != MapStop::GoOn;
  json["says"] = map_sentence(map);
  json["cells"] = Json::array();
  for (const MapCell& cell : cells) {
    json["cells"].push_back({{"x_mm", cell.place.x / kMillimetre},
                             {"y_mm", cell.place.y / kMillimetre},
                             {"stiffness", cell.stiffness},
                             {"stiffness_stddev", cell.stiffness_stddev},
                             {"inclusion", cell.inclusion}});
  }
  return json;
}

}  // namespace palp::judge
