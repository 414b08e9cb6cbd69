#include "lab/report/metric_plot.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "common/plot/line_plot.h"
#include "judge/metric_table.h"

namespace palp::lab {
namespace {

constexpr std::size_t kCurvesMax = 7;  // as many colours

std::optional<double> number_in(const std::string& label) {
  double value = 0;
  const char* const end = label.data() + label.size();
  const auto read = std::from_chars(label.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end) return std::nullopt;
  return value;
}

/// The first label that is a number in every case, and not the same in all if there is such a one.
std::optional<std::size_t> numeric_label(const std::vector<bool>& varying,
                                         const std::vector<CaseResult>& results) {
  std::optional<std::size_t> constant;
  for (std::size_t i = 0; i < varying.size(); ++i) {
    const bool numeric = std::all_of(results.begin(), results.end(), [i](const CaseResult& result) {
      return number_in(result.labels[i]).has_value();
    });
    if (numeric && varying[i]) return i;
    if (numeric && !constant) constant = i;
  }
  return constant;
}

/// Where words alone tell cases apart, each has its number.
double place_of(const CaseResult& result, std::optional<std::size_t> along) {
  return along ? *number_in(result.labels[*along]) : static_cast<double>(result.index);
}

/// By label: not equal in all cases.
std::vector<bool> varying_labels(std::size_t labels, const std::vector<CaseResult>& results) {
  std::vector<bool> varying(labels);
  for (const CaseResult& result : results) {
    for (std::size_t i = 0; i < labels; ++i) {
      varying[i] = varying[i] || result.labels[i] != results.front().labels[i];
    }
  }
  return varying;
}

/// What tells a case from others at the same place: its labels that are not equal in all of them.
std::string curve_of(const CaseResult& one,
                     std::optional<std::size_t> along,
                     const std::vector<bool>& varying) {
  std::string name;
  for (std::size_t i = 0; i < varying.size(); ++i) {
    if (along == i || !varying[i]) continue;
    name += (name.empty() ? "" : " ") + one.labels[i];
  }
  return name;
}

using Values = std::map<double, std::vector<double>>;  ///< [as the metric], by place

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A line through the medians and, where there are several values, each of them.
void add_curve(const std::string& name, const Values& values, std::vector<plot::Curve>& curves) {
  const int colour = static_cast<int>(curves.empty() ? 0 : curves.back().colour + 1);
  plot::Curve line{.name = name, .colour = colour};
  plot::Curve points{.mark = plot::Mark::Points, .colour = colour};
  bool several = values.size() == 1;  // one place makes no line
  for (const auto& [x, all] : values) {
    line.x.push_back(x);
    line.y.push_back(median(all));
    several = several || all.size() > 1;
    points.x.insert(points.x.end(), all.size(), x);
    points.y.insert(points.y.end(), all.begin(), all.end());
  }
  curves.push_back(std::move(line));
  if (several) curves.push_back(std::move(points));
}

}  // namespace

std::string metric_plot(const std::vector<std::string>& label_names,
                        const std::vector<CaseResult>& results,
                        const std::string& metric,
                        const std::string& title) {
  const auto at = judge::metric_index(metric);
  const auto varying = varying_labels(label_names.size(), results);
  const auto along = numeric_label(varying, results);
  if (!at) return {};
  std::map<std::string, Values> groups;
  plot::Curve all{.mark = plot::Mark::Points};
  for (const CaseResult& result : results) {
    const double value = result.values[*at];
    if (!std::isfinite(value)) continue;
    const double place = place_of(result, along);
    groups[curve_of(result, along, varying)][place].push_back(value);
    all.x.push_back(place);
    all.y.push_back(value);
  }
  std::vector<plot::Curve> curves;
  if (groups.size() > kCurvesMax) {
    curves.push_back(std::move(all));
  } else {
    for (const auto& [name, values] : groups) add_curve(name, values, curves);
  }
  plot::Axes axes;
  axes.title = title;
  axes.x_name = along ? label_names[*along] : "case";
  axes.y_name = metric;
  axes.x_logarithmic = axes.x_name == "rtt_ms";
  return plot::curves_svg(axes, curves);
}

}  // namespace palp::lab
