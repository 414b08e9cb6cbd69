#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "lab/plan/batch.h"

/// What a plan's runs say to scripts (JSON, CSV) and to people.
namespace palp::lab {

struct BatchAccount {
  std::string schema{"palp.montecarlo/1"};
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

/// The programs and machines that made the cases: one, or bits may differ.
[[nodiscard]] std::vector<std::string> makers(const Plan& plan,
                                              const std::vector<CaseResult>& results);

/// A header line and one row per case. Each row says of which plan it is, so that rows of several
/// files are known to belong together, who made it, and ends with a check over itself.
[[nodiscard]] std::string cases_csv(const Plan& plan, const std::vector<CaseResult>& results);

/// Rows as cases_csv() wrote them, of one shard or all. `plan` gets what they say of their plan;
/// with a count it is known from files before, and rows of another are refused.
[[nodiscard]] Result<std::vector<CaseResult>> read_cases_csv(const std::string& text,
                                                             const std::string& name,
                                                             Plan& plan);

/// Sorted: nothing where they are all cases of the plan, each once.
[[nodiscard]] Result<void> check_complete(const Plan& plan, const std::vector<CaseResult>& results);

}  // namespace palp::lab
