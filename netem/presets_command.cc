#include "netem/presets_command.h"

#include "common/config/json.h"
#include "common/config/number.h"
#include "netem/syntax/impairment_text.h"
#include "netem/syntax/presets.h"

namespace palp::netem {
namespace {

using config::Json;

std::string description(const std::string& name, const Timeline& preset) {
  std::string text = name + ": " + preset.means + '\n';
  if (preset.up.impairment == preset.down.impairment) {
    text += "  both ways  " + to_string(preset.up.impairment) + '\n';
  } else {
    text += "  up         " + to_string(preset.up.impairment) + '\n';
    text += "  down       " + to_string(preset.down.impairment) + '\n';
  }
  if (const std::size_t changes = preset.up.changes.size(); changes > 0) {
    text += "  events     " + std::to_string(changes) + " each way, ";
    text += "again every " + config::number_text(seconds(preset.up.loop)) + " s\n";
  }
  for (const std::string& source : preset.sources) text += "  source     " + source + '\n';
  return text;
}

Json preset_json(const std::string& name, const Timeline& preset) {
  return {{"name", name},
          {"means", preset.means},
          {"up", to_string(preset.up.impairment)},
          {"down", to_string(preset.down.impairment)},
          {"events_up", preset.up.changes.size()},
          {"events_down", preset.down.changes.size()},
          {"loop_s", seconds(preset.up.loop)},
          {"sources", preset.sources}};
}

}  // namespace

PresetsCommand::PresetsCommand(config::CommandLine& line) {
  config::CommandLine& verb = line.verb("presets", "the named links and where they come from");
  verb.argument("NAME", name_, "only this one");
  verb.toggle("--json", json_, "for programs");
}

config::ExitStatus PresetsCommand::run() const {
  std::string text;
  Json list = Json::array();
  for (const std::string& known : preset_names()) {
    if (!name_.empty() && known != name_) continue;
    const auto preset = find_preset(known);
    if (!preset) return config::refusal("palp-netem", preset.error());
    text += description(known, *preset);
    list.push_back(preset_json(known, *preset));
  }
  if (text.empty()) return config::refusal("palp-netem", find_preset(name_).error());
  if (json_) {
    const Json json{{"schema", "palp.presets/1"}, {"presets", list}};
    return {config::ExitCode::Done, json.dump(2)};
  }
  if (!name_.empty()) text += '\n' + std::string{preset_text(name_)};
  return {config::ExitCode::Done, text};
}

}  // namespace palp::netem
