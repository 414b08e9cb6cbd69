#pragma once

#include <string>
#include <vector>

#include "common/config/document.h"
#include "common/core/result.h"
#include "lab/plan/plan.h"
#include "lab/run/scenario.h"

/// Scenarios as text: messages LabScenario of proto/config.proto. Allocates, reads files.
namespace palp::lab {

/// One that comes with the lab ("metro"), or a text file.
[[nodiscard]] Result<config::Document> load_scenario(const std::string& name_or_path);

/// Everything a run needs. `document` has passed its check().
[[nodiscard]] Result<Scenario> make_scenario(const std::string& name,
                                             const config::Document& document);

/// Those that come with the lab.
[[nodiscard]] std::vector<NamedChoice> described_scenarios();

}  // namespace palp::lab
