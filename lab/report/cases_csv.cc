#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>

#include "judge/metric_table.h"
#include "lab/report/batch_report.h"
#include "lab/report/checked_rows.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

constexpr std::string_view kFixedFirst = "index,seed,digest,virtual_s,outcome,unstable,reason";
constexpr std::string_view kFixedLast =
    "plan,plan_cases,plan_seed,plan_coupling,plan_tissue,"
    "made_by";  ///< of the plan the same in all rows

std::string decimal(double value) {
  if (!std::isfinite(value)) return {};
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

/// As a cell: in quotes where it needs them (RFC 4180), on one line.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\r' || c == '\n' ? ' ' : c;
  }
  return quoted + '"';
}

std::string header_of_cases() {
  std::string text{kFixedFirst};
  for (const judge::Metric& metric : judge::metric_table()) text.append(",").append(metric.name);
  return text.append(",").append(kFixedLast);
}

}  // namespace

std::string cases_csv(const Plan& plan, const std::vector<CaseResult>& results) {
  std::string text = header_of_cases();
  for (const std::string& name : plan.label_names) text.append(",").append(cell(name));
  text.append(",").append(kCheckName) += '\n';
  const std::string of_plan = ',' + cell(plan.name) + ',' + std::to_string(plan.count) + ',' +
                              std::to_string(plan.seed) + ',' + cell(plan.coupling) + ',' +
                              cell(plan.tissue);
  for (const CaseResult& result : results) {
    std::string row = std::to_string(result.index) + ',' + std::to_string(result.seed) + ',' +
                      hexadecimal(result.digest) + ',' + decimal(result.virtual_span) + ',' +
                      result.outcome + ',' + (result.unstable ? "1" : "0") + ',' +
                      cell(result.unstable_reason);
    for (const double value : result.values) row.append(",").append(decimal(value));
    row += of_plan;
    row.append(",").append(cell(result.made_by.empty() ? plan.made_by : result.made_by));
    for (const std::string& label : result.labels) row.append(",").append(cell(label));
    text.append(with_check(row)) += '\n';
  }
  return text;
}

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else if (c != '\r') {
      lines.back() += c;
    }
  }
  return lines;
}

/// The cells of a line, as cell() made them.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      const bool twice = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (twice) cells.back() += line[++i];
      if (!twice) quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

template <class Number>
bool parse(const std::string& text, Number& value, int base = 0) {
  const char* end = text.data() + text.size();
  std::from_chars_result got{};
  if constexpr (std::is_floating_point_v<Number>) {
    if (text.empty()) {
      value = judge::kUndefined;
      return true;
    }
    got = std::from_chars(text.data(), end, value);
  } else {
    got = std::from_chars(text.data(), end, value, base == 0 ? 10 : base);
  }
  return got.ec == std::errc{} && got.ptr == end;
}

/// What the rows of a plan have in common.
struct PlanCells {
  std::string name;
  std::uint64_t count{};
  std::uint64_t seed{};
  std::string coupling;
  std::string tissue;
  bool operator==(const PlanCells&) const = default;
};

/// @returns false: they are not cells of kFixedLast.
bool parse(std::span<const std::string> cells, PlanCells& of_plan) {
  of_plan.name = cells[0];
  of_plan.coupling = cells[3];
  of_plan.tissue = cells[4];
  return parse(cells[1], of_plan.count) && parse(cells[2], of_plan.seed) && of_plan.count > 0;
}

std::string words_of(const PlanCells& of_plan) {
  return of_plan.name + ", " + std::to_string(of_plan.count) + " cases, seed " +
         std::to_string(of_plan.seed) + ", coupling " + of_plan.coupling + ", tissue " +
         of_plan.tissue;
}

/// The first rows tell what the plan is; all others must agree.
Result<void> agree(const PlanCells& told, const std::string& where, Plan& plan) {
  if (plan.count == 0) {
    plan.name = told.name;
    plan.count = told.count;
    plan.seed = told.seed;
    plan.coupling = told.coupling;
    plan.tissue = told.tissue;
  }
  const PlanCells known{plan.name, plan.count, plan.seed, plan.coupling, plan.tissue};
  if (told == known) return {};
  return fail(where + " is of another plan (" + words_of(told) + ") than what stands before (" +
              words_of(known) + ")");
}

}  // namespace

Result<std::vector<CaseResult>> read_cases_csv(const std::string& text,
                                               const std::string& name,
                                               Plan& plan) {
  const std::vector<std::string> lines = lines_of(text);
  const auto table = judge::metric_table();
  const std::string expected = header_of_cases();
  if (lines.front().rfind(expected, 0) != 0) {
    return fail(name + ": the first line is not that of a cases file of this version");
  }
  const std::size_t fixed = cells_of(expected).size();
  const std::size_t of_plan = fixed - cells_of(std::string{kFixedLast}).size();
  const std::vector<std::string> header = cells_of(lines.front());
  if (header.size() <= fixed || header.back() != kCheckName) {
    return fail(name + ": the last column is not that of a cases file of this version");
  }
  const std::vector<std::string> labels{header.begin() + static_cast<std::ptrdiff_t>(fixed),
                                        header.end() - 1};
  if (plan.count > 0 && labels != plan.label_names) {
    return fail(name + ": its columns are not those of the files before");
  }
  plan.label_names = labels;
  std::vector<CaseResult> results;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    const std::string where = name + ": line " + std::to_string(i + 1);
    if (!holds_check(lines[i])) {
      return fail(where + " was not written whole, or was changed: make its cases again");
    }
    const std::vector<std::string> fields = cells_of(lines[i]);
    CaseResult result;
    PlanCells told;
    bool sound = fields.size() == header.size() && parse(fields[0], result.index) &&
                 parse(fields[1], result.seed) && parse(fields[2], result.digest, 16) &&
                 parse(fields[3], result.virtual_span);
    for (std::size_t m = 0; sound && m < table.size(); ++m) {
      sound = parse(fields[7 + m], result.values.emplace_back());
    }
    sound = sound && parse(std::span{fields}.subspan(of_plan), told);
    if (!sound) return fail(where + " is not a row of a case");
    if (auto agreed = agree(told, where, plan); !agreed) return tl::unexpected(agreed.error());
    result.outcome = fields[4];
    result.unstable = fields[5] == "1";
    result.unstable_reason = fields[6];
    result.labels.assign(fields.begin() + static_cast<std::ptrdiff_t>(fixed), fields.end() - 1);
    result.made_by = fields[fixed - 1];
    results.push_back(std::move(result));
  }
  return results;
}

Result<void> check_complete(const Plan& plan, const std::vector<CaseResult>& results) {
  std::vector<std::uint64_t> indices;
  indices.reserve(results.size());
  for (const CaseResult& result : results) indices.push_back(result.index);
  return check_all_there(indices, plan.count);
}

}  // namespace palp::lab
