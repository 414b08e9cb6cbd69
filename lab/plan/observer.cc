#include "lab/plan/observer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/random.h"
#include "judge/metric_table.h"

namespace palp::lab {
namespace {

constexpr std::array kWebers{0.08, 0.15, 0.22};
constexpr double kQuartile = 0.6745;  // of the normal distribution: 75 % lie below

}  // namespace

double right_answers(double ratio, double weber) noexcept {
  if (!(ratio > 0)) return 0.5;
  const double sigma = std::log1p(weber) / (std::sqrt(2.0) * kQuartile);
  return normal_cdf(std::log(ratio) / (std::sqrt(2.0) * sigma));
}

std::vector<ObserverRow> observe(const std::vector<CaseResult>& results) {
  const std::size_t truth = *judge::metric_index("ratio_true");
  const std::size_t error = *judge::metric_index("ratio_error");
  std::vector<std::vector<std::string>> groups;
  for (const CaseResult& result : results) {
    if (std::find(groups.begin(), groups.end(), result.labels) == groups.end()) {
      groups.push_back(result.labels);
    }
  }
  std::vector<ObserverRow> rows;
  for (const std::vector<std::string>& labels : groups) {
    for (const double weber : kWebers) {
      ObserverRow row{labels, weber, 0, 0};
      double count = 0;
      for (const CaseResult& result : results) {
        if (result.labels != labels) continue;
        row.right_true += right_answers(result.values[truth], weber);
        row.right_felt += right_answers(result.values[truth] * (1 + result.values[error]), weber);
        ++count;
      }
      row.right_true /= count;
      row.right_felt /= count;
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

double worst_loss(const Plan& plan,
                  const std::vector<ObserverRow>& rows,
                  const std::vector<Setting>& labels) {
  double worst = judge::kUndefined;
  for (const ObserverRow& row : rows) {
    const bool chosen = std::all_of(labels.begin(), labels.end(), [&](const Setting& wanted) {
      const auto found = std::find(plan.label_names.begin(), plan.label_names.end(), wanted.path);
      return found != plan.label_names.end() &&
             row.labels[static_cast<std::size_t>(found - plan.label_names.begin())] == wanted.value;
    });
    if (chosen) worst = std::isnan(worst) ? row.loss() : std::max(worst, row.loss());
  }
  return worst;
}

}  // namespace palp::lab
