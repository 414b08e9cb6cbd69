#include "lab/report/batch_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "common/config/json.h"
#include "judge/metric_table.h"
#include "lab/plan/observer.h"
#include "lab/report/gesture_table.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

using config::Json;

constexpr std::size_t kWorstMax = 3;  ///< of each metric

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
    one["right_true"] = row.right_true;
    one["right_felt"] = row.right_felt;
    one["loss"] = row.loss();
    json.push_back(one);
  }
  return json;
}

std::uint64_t unstable_count(const std::vector<CaseResult>& results) {
  return static_cast<std::uint64_t>(
      std::count_if(results.begin(), results.end(), [](const auto& r) { return r.unstable; }));
}

/// In how many of the cases a metric of 0 and 1 is 1.
std::uint64_t count_of(const std::vector<CaseResult>& results, std::string_view metric) {
  const std::size_t index = *judge::metric_index(metric);
  return static_cast<std::uint64_t>(std::count_if(
      results.begin(), results.end(), [&](const auto& r) { return r.values[index] == 1; }));
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
                  "%-26s %10.4f %10.4f %10.4f %10.4f %10.4f %9llu\n",
                  std::string{table[metric].name}.c_str(),
                  spread.p50,
                  spread.p90,
                  spread.p95,
                  spread.p99,
                  spread.max,
                  static_cast<unsigned long long>(spread.undefined));
    text += line.data();
  }
  return text;
}

}  // namespace

std::vector<std::string> makers(const Plan& plan, const std::vector<CaseResult>& results) {
  std::set<std::string> all;
  for (const CaseResult& result : results) {
    all.insert(result.made_by.empty() ? plan.made_by : result.made_by);
  }
  all.erase("");
  return {all.begin(), all.end()};
}

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
  json["unstable_hand"] = count_of(results, "unstable_hand");
  json["unstable_tip"] = count_of(results, "unstable_tip");
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
    metrics[name] = {{"p50", spread.p50},
                     {"p90", spread.p90},
                     {"p95", spread.p95},
                     {"p99", spread.p99},
                     {"max", spread.max}};
    if (spread.undefined > 0) undefined[name] = spread.undefined;
  }
  json["undefined"] = undefined;
  json["metrics"] = metrics;
  json["worst"] = worst_of(results);
  if (plan.name == "inc") {
    const auto rows = observe(results);
    json["observer_loss_max"] = worst_loss(plan, rows, kObserved);
    json["observer"] = observer_rows(plan, rows);
  }
  const bool merged = account.cores == 0;
  json["cores"] = merged ? Json(nullptr) : Json(account.cores);
  json["cpu_s"] = merged ? Json(nullptr) : Json(account.cpu);
  json["wall_s"] = merged ? Json(nullptr) : Json(account.wall);
  json["made_by"] = makers(plan, results);
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
                "%-26s %10s %10s %10s %10s %10s %9s\n",
                plan.name.c_str(),
                results.size(),
                static_cast<unsigned long long>(plan.seed),
                plan.coupling.empty() ? "as listed" : plan.coupling.c_str(),
                plan.tissue.empty() ? "as listed" : plan.tissue.c_str(),
                static_cast<unsigned long long>(unstable_count(results)),
                "absolute value",
                "median",
                "p90",
                "p95",
                "p99",
                "max",
                "undefined");
  text += line.data();
  text += metric_rows(results);
  if (plan.name == "gestures") text += gesture_table(plan, results);
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

}  // namespace palp::lab
