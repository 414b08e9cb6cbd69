#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "lab/batch.h"

/// What a plan's runs say to scripts (JSON, CSV) and to people.
namespace palp::lab {

struct BatchAccount {
  std::string schema{"palp.montecarlo/1"};
  std::string coupling{};
  std::string shard{};  ///< "i/n", empty: whole
  std::uint64_t cores{};
  double cpu{};             ///< [s]
  double wall{};            ///< [s]
  std::string cases_csv{};  ///< where the rows are; empty: nowhere
};

[[nodiscard]] std::string batch_report(const Plan& plan,
                                       const std::vector<CaseResult>& results,
                                       const BatchAccount& account);
[[nodiscard]] std::string batch_summary(const Plan& plan,
                                        const std::vector<CaseResult>& results,
                                        const BatchAccount& account);

/// A header line and one row per case.
[[nodiscard]] std::string cases_csv(const Plan& plan, const std::vector<CaseResult>& results);

/// Rows as cases_csv() wrote them, of one shard or all. `plan` gets the name and labels.
[[nodiscard]] Result<std::vector<CaseResult>> read_cases_csv(const std::string& text,
                                                             const std::string& name,
                                                             Plan& plan);

}  // namespace palp::lab
