#include "lab/partial_cases.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "common/core/whole_file.h"
#include "lab/report/batch_report.h"

namespace palp::lab {
namespace {

constexpr std::size_t kPartialSizeMax = std::size_t{1} << 30;  // [bytes], as of a cases file

constexpr const char* kPartialEnding = ".partial";

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

/// The whole lines of what an interrupted batch left; empty: it left none.
std::string whole_lines(const std::string& path) {
  auto text = read_whole_file(path, kPartialSizeMax);
  if (!text) return {};
  text->resize(text->rfind('\n') == std::string::npos ? 0 : text->rfind('\n') + 1);
  return std::move(*text);
}

}  // namespace

Result<PartialCases> PartialCases::begin(const std::string& path,
                                         bool resume,
                                         Plan& plan,
                                         std::vector<CaseResult>& before) {
  namespace fs = std::filesystem;
  PartialCases made;
  std::error_code ignored;
  const bool elsewhere = fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
  if (path.empty() || elsewhere) {
    if (resume) return fail("--resume needs the file that --cases names");
    return made;
  }
  const std::string partial = path + kPartialEnding;
  const std::string text = resume ? whole_lines(partial) : std::string{};
  if (!text.empty()) {
    auto rows = read_cases_csv(text, partial, plan);
    if (!rows) return tl::unexpected(rows.error());
    if (auto fits = take_out(*rows, partial, plan); !fits) return tl::unexpected(fits.error());
    before = std::move(*rows);
    fs::resize_file(partial, text.size(), ignored);  // without a line that breaks off
  }
  made.file_.reset(std::fopen(partial.c_str(), text.empty() ? "w" : "a"));
  if (!made.file_) return fail("cannot write " + partial);
  if (text.empty()) {
    (void)std::fputs(cases_csv(plan, {}).c_str(), made.file_.get());
    (void)std::fflush(made.file_.get());
  }
  return made;
}

void PartialCases::add(const Plan& plan, const CaseResult& result) {
  if (!file_) return;
  // A row that the disk does not take is made again.
  (void)std::fputs(only_rows(cases_csv(plan, {result})).c_str(), file_.get());
  (void)std::fflush(file_.get());
}

void remove_partial_cases(const std::string& path) {
  std::error_code ignored;
  if (!path.empty()) std::filesystem::remove(path + kPartialEnding, ignored);
}

}  // namespace palp::lab
