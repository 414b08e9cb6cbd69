#include "monitor/status_json.h"

#include "common/config/json.h"
#include "common/record/notes.h"
#include "common/record/wall_clock.h"

namespace palp::monitor {
namespace {

using config::Json;

double in_mm(double length) noexcept { return length * 1e3; }

Json text_of(std::uint16_t code) {
  return code == 0 ? std::string_view{} : record::note_text(code);
}

/// Of a message like any other: what it says is what there is.
std::string schema_of(const std::string& message) {
  const Json example = Json::parse(message);
  Json schema;
  schema["type"] = "object";
  schema["properties"] = Json::object();
  for (const std::string_view name : example.names()) {
    const Json& value = example[name];
    const char* const type = value.text() ? "string" : value.truth() ? "boolean" : "number";
    schema["properties"][name] = Json{{"type", type}};
  }
  return schema.dump();
}

}  // namespace

std::string status_json(const LiveStatus& status, const Pilot& pilot, std::size_t clients) {
  const SiteTick& tick = status.tick;
  const LinkHeard& heard = status.heard;
  Json json;
  json["state"] = to_string(tick.state);
  json["reason"] = text_of(status.reason);
  json["refused"] = text_of(status.refused);
  json["epoch"] = tick.epoch;
  json["position_mm"] = in_mm(tick.position);
  json["force_n"] = tick.force;
  json["force_missing_n"] = tick.force_missing;
  json["force_short"] = text_of(tick.short_note);
  json["force_short_n"] = tick.short_by;
  json["x_mm"] = in_mm(tick.place.x);
  json["y_mm"] = in_mm(tick.place.y);
  json["link"] = to_string(heard.state);
  json["session"] = heard.session_id == 0 ? "" : record::session_id_text(heard.session_id);
  json["gap_ms"] = seconds(heard.gap) * 1e3;
  json["round_trip_ms"] = seconds(heard.round_trip) * 1e3;
  json["peer_heard"] = heard.peer_heard;
  json["peer_state"] = to_string(heard.peer_state);
  json["peer_sampled"] = status.peer_sampled;
  json["peer_position_mm"] = in_mm(status.peer_position);
  json["peer_force_n"] = status.peer_force;
  json["peer_force_min_n"] = status.peer_force_min;
  json["peer_force_max_n"] = status.peer_force_max;
  json["peer_x_mm"] = in_mm(heard.peer_place.x);
  json["peer_y_mm"] = in_mm(heard.peer_place.y);
  json["ticks"] = status.ticks;
  json["ticks_missed"] = status.ticks_missed;
  json["dropped"] = status.dropped;
  json["recording"] = status.recording;
  json["clients"] = clients;
  json["pilot"] = pilot.client();
  json["pilot_name"] = pilot.name();
  json["pilot_obstacle"] = pilot.client() == 0 ? std::string_view{} : pilot.obstacle();
  return json.dump();
}

std::string client_json(Duration round_trip) {
  return Json{{"round_trip_ms", seconds(round_trip) * 1e3}}.dump();
}

std::string status_schema() { return schema_of(status_json({}, {}, 0)); }

std::string client_schema() { return schema_of(client_json({})); }

std::string video_json(const VideoShown& shown) {
  Json json;
  json["sending"] = shown.state == video::VideoState::Sending;
  json["state"] = video::to_string(shown.state);
  json["age_ms"] = seconds(shown.age) * 1e3;
  json["kbps"] = shown.kbps;
  json["fps"] = shown.fps;
  json["standing_ms"] = seconds(shown.standing) * 1e3;
  json["touch_held_ms"] = seconds(shown.touch_held) * 1e3;
  json["delivered"] = shown.delivered;
  json["repaired"] = shown.repaired;
  json["not_shown"] = shown.not_shown;
  return json.dump();
}

std::string video_schema() { return schema_of(video_json({})); }

}  // namespace palp::monitor
