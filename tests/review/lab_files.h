#pragma once

#include <string>
#include <vector>

#include "common/record/byte_sink.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"

/// Session files of a short session in virtual time.
namespace palp::review::test {

struct LabFiles {
  record::MemorySink surgeon;
  record::MemorySink patient;
};

/// `settings`: "path=value" over the scenario `name`.
inline lab::Scenario lab_scenario(Duration duration,
                                  const std::vector<std::string>& settings = {},
                                  const std::string& name = "metro") {
  auto document = lab::load_scenario(name).value();
  for (const std::string& setting : settings) (void)document.set(setting);
  lab::Scenario scenario = lab::make_scenario(name, document).value();
  scenario.duration = duration;
  return scenario;
}

inline LabFiles lab_files(const lab::Scenario& scenario) {
  LabFiles files;
  (void)lab::simulate(scenario, {.surgeon = &files.surgeon, .patient = &files.patient});
  return files;
}

}  // namespace palp::review::test
