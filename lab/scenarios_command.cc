#include "lab/scenarios_command.h"

#include <algorithm>
#include <string>
#include <vector>

#include "common/config/json.h"
#include "lab/plan/plan.h"
#include "lab/plan/scenario_file.h"

namespace palp::lab {
namespace {

using config::Json;

std::string choices_text(const std::vector<NamedChoice>& choices) {
  std::string lines;
  for (NamedChoice one : choices) {
    one.name.resize(std::max<std::size_t>(one.name.size() + 2, 16), ' ');
    lines += one.name + one.means + "\n";
  }
  return lines;
}

Json choices_json(const std::vector<NamedChoice>& choices) {
  Json list = Json::array();
  for (const NamedChoice& one : choices) {
    list.push_back({{"name", one.name}, {"means", one.means}});
  }
  return list;
}

}  // namespace

ScenariosCommand::ScenariosCommand(config::CommandLine& line) {
  config::CommandLine& verb = line.verb("scenarios", "the scenarios and sets with a name");
  verb.toggle("--json", json_, "for programs");
}

config::ExitStatus ScenariosCommand::run() const {
  if (!json_) {
    return {config::ExitCode::Done,
            choices_text(described_scenarios()) + choices_text(described_sets())};
  }
  const Json json{{"schema", "palp.scenarios/1"},
                  {"scenarios", choices_json(described_scenarios())},
                  {"sets", choices_json(described_sets())}};
  return {config::ExitCode::Done, json.dump(2)};
}

}  // namespace palp::lab
