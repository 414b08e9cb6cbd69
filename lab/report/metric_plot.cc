#include "lab/report/metric_plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "judge/metric_table.h"

namespace palp::lab {
namespace {

/// A label, or the end of one, and its words.
struct Words {
  std::string_view name;
  std::string_view words;
};
constexpr std::array kKnown{Words{"rtt_ms", "round trip [ms]"},
                            Words{"delay_ms", "delay, one way [ms]"},
                            Words{"jitter", "jitter, share of the delay"},
                            Words{"loss", "share of lost datagrams"},
                            Words{"k_p_n_per_m", "spring k_p [N/m]"},
                            Words{"servo_hz", "bandwidth of the stage [Hz]"},
                            Words{"inclusion_mm", "depth of the inclusion [mm]"}};
constexpr std::array kUnits{Words{"_n_per_m", " [N/m]"},
                            Words{"_m_per_s", " [m/s]"},
                            Words{"_per_s", " [1/s]"},
                            Words{"_ms", " [ms]"},
                            Words{"_us", " [us]"},
                            Words{"_mm", " [mm]"},
                            Words{"_hz", " [Hz]"},
                            Words{"_kg", " [kg]"},
                            Words{"_s", " [s]"},
                            Words{"_m", " [m]"},
                            Words{"_n", " [N]"}};

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

/// A value in a legend: words as they are, a number with its name and unit: "memory = 2 s".
std::string value_words(const std::string& label, const std::string& value) {
  if (!number_in(value)) return value;
  std::string words = axis_words(label);
  const auto unit = words.find(" [");
  if (unit == std::string::npos) return words + " = " + value;
  words.pop_back();  // the bracket
  return words.substr(0, unit) + " = " + value + " " + words.substr(unit + 2);
}

/// What tells a case from others at the same place: its labels that are not equal in all of them.
std::string curve_of(const CaseResult& one,
                     const std::vector<std::string>& label_names,
                     std::optional<std::size_t> along,
                     const std::vector<bool>& varying) {
  std::string name;
  for (std::size_t i = 0; i < varying.size(); ++i) {
    if (along == i || !varying[i]) continue;
    name += (name.empty() ? "" : ", ") + value_words(label_names[i], one.labels[i]);
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
  const int colour = curves.empty() ? 0 : curves.back().colour + 1;
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

plot::Figure metric_plot(const std::vector<std::string>& label_names,
                         const std::vector<CaseResult>& results,
                         const std::string& metric,
                         const std::string& title) {
  const auto at = judge::metric_index(metric);
  const auto varying = varying_labels(label_names.size(), results);
  const auto along = numeric_label(varying, results);
  if (!at) return {};
  const judge::Metric& shown = judge::metric_table()[*at];
  std::map<std::string, Values> groups;
  plot::Curve all{.mark = plot::Mark::Points};
  for (const CaseResult& result : results) {
    const double value = shown.scale * result.values[*at];
    if (!std::isfinite(value)) continue;
    const double place = place_of(result, along);
    groups[curve_of(result, label_names, along, varying)][place].push_back(value);
    all.x.push_back(place);
    all.y.push_back(value);
  }
  std::vector<plot::Curve> curves;
  if (groups.size() > plot::kCurveColours) {
    curves.push_back(std::move(all));
  } else {
    for (const auto& [name, values] : groups) add_curve(name, values, curves);
  }
  const std::string label = along ? label_names[*along] : "case";
  return {.title = title,
          .panels = {{.axes = {.x_name = axis_words(label),
                               .y_name = std::string{shown.axis},
                               .x_logarithmic = label == "rtt_ms"},
                      .curves = std::move(curves)}}};
}

std::string axis_words(const std::string& label) {
  for (const Words& known : kKnown) {
    if (label == known.name) return std::string{known.words};
  }
  std::string words = label.substr(label.rfind('.') + 1);  // of a path its end
  for (const Words& unit : kUnits) {
    if (!words.ends_with(unit.name)) continue;
    words.resize(words.size() - unit.name.size());
    words += unit.words;
    break;
  }
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

}  // namespace palp::lab
