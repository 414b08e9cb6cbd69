#include "lab/partial_cases.h"

#include <algorithm>
#include <map>
#include <utility>

#include "lab/report/batch_report.h"

namespace palp::lab {
namespace {

/// All but what cases_csv() writes before its rows.
std::string only_rows(const std::string& csv) { return csv.substr(csv.find('\n') + 1); }

/// Takes the cases of `rows` out of `plan`; refuses what it does not have.
Result<void> take_out(const std::vector<CaseResult>& rows, const std::string& path, Plan& plan) {
  std::map<std::uint64_t, const CaseResult*> done;
  for (const CaseResult& row : rows) done[row.index] = &row;
  std::vector<Case> missing;
  for (Case& one : plan.cases) {
    const auto found = done.find(one.index);
    if (found == done.end()) {
      missing.push_back(std::move(one));
      continue;
    }
    if (found->second->seed != one.seed || found->second->labels != one.labels) {
      return fail(path + ": case " + std::to_string(one.index) + " is of another plan");
    }
    done.erase(found);
  }
  if (!done.empty()) {
    return fail(path + ": case " + std::to_string(done.begin()->first) + " is not asked for");
  }
  plan.cases = std::move(missing);
  return {};
}

}  // namespace

Result<PartialCases> PartialCases::begin(const std::string& path,
                                         bool resume,
                                         Plan& plan,
                                         std::vector<CaseResult>& before) {
  auto rows = PartialRows::open(path, resume);
  if (!rows) return tl::unexpected(rows.error());
  if (!rows->before().empty()) {
    auto found = read_cases_csv(rows->before(), rows->file(), plan);
    if (!found) return tl::unexpected(found.error());
    if (auto fits = take_out(*found, rows->file(), plan); !fits) {
      return tl::unexpected(fits.error());
    }
    before = std::move(*found);
  }
  if (auto begun = rows->begin(cases_csv(plan, {})); !begun) return tl::unexpected(begun.error());
  return PartialCases{std::move(*rows)};
}

void PartialCases::add(const Plan& plan, const CaseResult& result) {
  rows_.add(only_rows(cases_csv(plan, {result})));
}

}  // namespace palp::lab
