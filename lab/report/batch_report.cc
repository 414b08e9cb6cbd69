#include "lab/report/batch_report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>

#include "common/config/json.h"
#include "judge/metric_table.h"
#include "lab/plan/observer.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

using config::Json;

constexpr std::size_t kWorstMax = 3;  ///< of each metric
constexpr std::string_view kFixedFirst = "index,seed,digest,virtual_s,outcome,unstable,reason";
constexpr std::string_view kFixedLast =
    "plan,plan_cases,plan_seed,plan_coupling,plan_tissue";  ///< the same in all rows

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string decimal(double value) {
  if (!std::isfinite(value)) return {};
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

Json worst_of(const std::vector<CaseResult>& results) {
  Json worst = Json::array();
  const auto table = judge::metric_table();
  for (std::size_t metric = 0; metric < table.size(); ++metric) {
    std::vector<const CaseResult*> order;
    for (const CaseResult& result : results) {
      if (std::isfinite(result.values[metric])) order.push_back(&result);
    }
    const std::size_t count = std::min(kWorstMax, order.size());
    const auto larger = [metric](const CaseResult* a, const CaseResult* b) {
      const double x = std::abs(a->values[metric]);
      const double y = std::abs(b->values[metric]);
      return x != y ? x > y : a->index < b->index;
    };
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(), larger);
    for (std::size_t i = 0; i < count; ++i) {
      worst.push_back({{"case", order[i]->index},
                       {"seed", order[i]->seed},
                       {"metric", table[metric].name},
                       {"value", order[i]->values[metric]}});
    }
  }
  return worst;
}

/// The link of the set `inc` for which the target is set.
const std::vector<Setting> kObserved{{"rtt_ms", "500"}, {"loss", "0.05"}};

Json observer_rows(const Plan& plan, const std::vector<ObserverRow>& rows) {
  Json json = Json::array();
  for (const ObserverRow& row : rows) {
    Json one;
    for (std::size_t i = 0; i < plan.label_names.size(); ++i) {
      one[plan.label_names[i]] = row.labels[i];
    }
    one["weber"] = row.weber;
    one["right_true"] = number(row.right_true);
    one["right_felt"] = number(row.right_felt);
    one["loss"] = number(row.loss());
    json.push_back(one);
  }
  return json;
}

std::uint64_t unstable_count(const std::vector<CaseResult>& results) {
  return static_cast<std::uint64_t>(
      std::count_if(results.begin(), results.end(), [](const auto& r) { return r.unstable; }));
}

std::string metric_rows(const std::vector<CaseResult>& results) {
  std::array<char, 240> line{};
  std::string text;
  const auto table = judge::metric_table();
  for (std::size_t metric = 0; metric < table.size(); ++metric) {
    const Spread spread = spread_of(results, metric);
    if (spread.undefined == results.size()) continue;
    std::snprintf(line.data(),
                  line.size(),
                  "%-26s %10.4f %10.4f %10.4f %9llu\n",
                  std::string{table[metric].name}.c_str(),
                  spread.p50,
                  spread.p95,
                  spread.max,
                  static_cast<unsigned long long>(spread.undefined));
    text += line.data();
  }
  return text;
}

}  // namespace

std::string batch_report(const Plan& plan,
                         const std::vector<CaseResult>& results,
                         const BatchAccount& account) {
  Json json;
  json["schema"] = account.schema;
  json["set"] = plan.name;
  json["count"] = results.size();
  json["seed"] = plan.seed;
  json["shard"] = account.shard.empty() ? Json(nullptr) : Json(account.shard);
  json["coupling"] = plan.coupling.empty() ? Json(nullptr) : Json(plan.coupling);
  json["tissue"] = plan.tissue.empty() ? Json(nullptr) : Json(plan.tissue);
  json["digest"] = hexadecimal(digest_of(results));
  json["unstable"] = unstable_count(results);
  Json outcomes = Json::object();
  std::map<std::string, std::uint64_t> ends;
  for (const CaseResult& result : results) ++ends[result.outcome];
  for (const auto& [outcome, count] : ends) outcomes[outcome.empty() ? "cut" : outcome] = count;
  json["outcomes"] = outcomes;
  Json undefined = Json::object();
  Json metrics = Json::object();
  const auto table = judge::metric_table();
  for (std::size_t metric = 0; metric < table.size(); ++metric) {
    const Spread spread = spread_of(results, metric);
    if (spread.undefined == results.size()) continue;
    const std::string name{table[metric].name};
    metrics[name] = {
        {"p50", number(spread.p50)}, {"p95", number(spread.p95)}, {"max", number(spread.max)}};
    if (spread.undefined > 0) undefined[name] = spread.undefined;
  }
  json["undefined"] = undefined;
  json["metrics"] = metrics;
  json["worst"] = worst_of(results);
  if (plan.name == "inc") {
    const auto rows = observe(results);
    json["observer_loss_max"] = number(worst_loss(plan, rows, kObserved));
    json["observer"] = observer_rows(plan, rows);
  }
  const bool merged = account.cores == 0;
  json["cores"] = merged ? Json(nullptr) : Json(account.cores);
  json["cpu_s"] = merged ? Json(nullptr) : Json(account.cpu);
  json["wall_s"] = merged ? Json(nullptr) : Json(account.wall);
  json["cases_csv"] = account.cases_csv.empty() ? Json(nullptr) : Json(account.cases_csv);
  // A file's name need not be UTF-8.
  return json.dump(2) + "\n";
}

std::string batch_summary(const Plan& plan,
                          const std::vector<CaseResult>& results,
                          const BatchAccount& account) {
  std::array<char, 240> line{};
  std::string text;
  std::snprintf(line.data(),
                line.size(),
                "set %s, %zu cases, seed %llu, coupling %s, tissue %s: %llu unstable\n"
                "%-26s %10s %10s %10s %9s\n",
                plan.name.c_str(),
                results.size(),
                static_cast<unsigned long long>(plan.seed),
                plan.coupling.empty() ? "as listed" : plan.coupling.c_str(),
                plan.tissue.empty() ? "as listed" : plan.tissue.c_str(),
                static_cast<unsigned long long>(unstable_count(results)),
                "absolute value",
                "median",
                "p95",
                "max",
                "undefined");
  text += line.data();
  text += metric_rows(results);
  double virtual_span = 0;
  for (const CaseResult& result : results) virtual_span += result.virtual_span;
  if (plan.name == "inc") {
    std::snprintf(line.data(),
                  line.size(),
                  "a person loses at most %.2f of 100 right answers (worst link, 500 ms)\n",
                  100 * worst_loss(plan, observe(results), kObserved));
    text += line.data();
  }
  std::snprintf(line.data(),
                line.size(),
                "digest %s; %.0f s of virtual time",
                hexadecimal(digest_of(results)).c_str(),
                virtual_span);
  text += line.data();
  // Rows that were merged have no machine of their own.
  if (account.cores > 0) {
    std::snprintf(line.data(),
                  line.size(),
                  " in %.1f s on %llu cores: %.0f times per core",
                  account.wall,
                  static_cast<unsigned long long>(account.cores),
                  virtual_span / account.cpu);
    text += line.data();
  }
  return text + "\n";
}

namespace {

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
  text += '\n';
  const std::string of_plan = ',' + cell(plan.name) + ',' + std::to_string(plan.count) + ',' +
                              std::to_string(plan.seed) + ',' + cell(plan.coupling) + ',' +
                              cell(plan.tissue);
  for (const CaseResult& result : results) {
    text += std::to_string(result.index) + ',' + std::to_string(result.seed) + ',' +
            hexadecimal(result.digest) + ',' + decimal(result.virtual_span) + ',' + result.outcome +
            ',' + (result.unstable ? "1" : "0") + ',' + cell(result.unstable_reason);
    for (const double value : result.values) text.append(",").append(decimal(value));
    text += of_plan;
    for (const std::string& label : result.labels) text.append(",").append(cell(label));
    text += '\n';
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
  const std::vector<std::string> labels{header.begin() + static_cast<std::ptrdiff_t>(fixed),
                                        header.end()};
  if (plan.count > 0 && labels != plan.label_names) {
    return fail(name + ": its columns are not those of the files before");
  }
  plan.label_names = labels;
  std::vector<CaseResult> results;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    const std::string where = name + ": line " + std::to_string(i + 1);
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
    result.labels.assign(fields.begin() + static_cast<std::ptrdiff_t>(fixed), fields.end());
    results.push_back(std::move(result));
  }
  return results;
}

Result<void> check_complete(const Plan& plan, const std::vector<CaseResult>& results) {
  const auto of = [&](std::uint64_t index) {
    return "case " + std::to_string(index) + " of " + std::to_string(plan.count);
  };
  if (results.empty()) return fail("there is no case in these files");
  std::uint64_t next = 0;
  for (const CaseResult& result : results) {
    if (result.index < next) return fail(of(result.index) + " is given twice");
    if (result.index > next) break;
    ++next;
  }
  if (next == plan.count && results.size() == plan.count) return {};
  return fail(of(next) + " is missing: merge the cases of all shards of one plan");
}

}  // namespace palp::lab
