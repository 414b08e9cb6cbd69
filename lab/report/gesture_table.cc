#include "lab/report/gesture_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "common/core/formatted.h"
#include "judge/metric_table.h"
#include "lab/plan/gesture_set.h"
#include "lab/plan/set_case.h"

namespace palp::lab {
namespace {

/// Which of the labels has that name.
std::size_t label_of(const Plan& plan, std::string_view name) {
  const auto& names = plan.label_names;
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string cell(const CaseResult& result, std::string_view metric) {
  const double value = result.values[*judge::metric_index(metric)];
  const char* mark = result.unstable ? " !" : "";
  if (!std::isfinite(value)) return std::string{"-"} + mark;
  if (metric == "drag_shift_s") return formatted("%.2f s", value) + mark;
  const double error = metric.starts_with("share_") ? value - 1 : value;
  const double percent = 100 * error;
  return formatted(std::abs(percent) < 9.95 ? "%+.1f %%" : "%+.0f %%", percent) + mark;
}

/// The script of a gesture has the name of its first.
std::string_view name_of_script(const Gesture& gesture) {
  return std::find_if(kGestures.begin(),
                      kGestures.end(),
                      [&](const Gesture& other) { return other.script == gesture.script; })
      ->name;
}

}  // namespace

std::string gesture_table(const Plan& plan, const std::vector<CaseResult>& results) {
  const std::size_t gesture_at = label_of(plan, "gesture");
  const std::size_t trip_at = label_of(plan, "rtt_ms");
  const std::size_t grip_at = label_of(plan, "grip");
  std::string head = "| gesture | round trip ms |";
  std::string rule = "| --- | --- |";
  for (const std::string_view grip : kSetGrips) {
    head += " " + std::string{grip} + " |";
    rule += " --- |";
  }
  std::string text = head + "\n" + rule + "\n";
  for (const Gesture& gesture : kGestures) {
    const std::string_view script = name_of_script(gesture);
    std::string trip;  // of the last row
    for (const CaseResult& first : results) {
      if (first.labels[gesture_at] != script || first.labels[trip_at] == trip) continue;
      trip = first.labels[trip_at];
      text += "| " + std::string{gesture.name} + " | " + trip + " |";
      for (const std::string_view grip : kSetGrips) {
        const auto of = std::find_if(results.begin(), results.end(), [&](const CaseResult& one) {
          return one.labels[gesture_at] == script && one.labels[trip_at] == trip &&
                 one.labels[grip_at] == grip;
        });
        text += of == results.end() ? " |" : " " + cell(*of, gesture.metric) + " |";
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace palp::lab
