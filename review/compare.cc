#include "review/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/core/printable.h"
#include "judge/metric_table.h"
#include "review/text.h"

namespace palp::review {
namespace {

constexpr std::size_t kNameWidth = 28;
constexpr std::size_t kValueWidth = 14;

/// Four digits that count.
std::string value_text(double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 40> text{};
  const int size = std::snprintf(text.data(), text.size(), "%.4g", value);
  return {text.data(), static_cast<std::size_t>(size)};
}

std::string line_of(const std::string& name, const std::vector<Compared>& sessions, auto cell) {
  std::string line = left(name, kNameWidth);
  for (const Compared& one : sessions) line += ' ' + right(cell(one), kValueWidth);
  return line + '\n';
}

}  // namespace

std::string comparison_text(const std::vector<Compared>& sessions) {
  const auto name = [](const Compared& one) { return printable(one.name); };
  const auto coupling = [](const Compared& one) {
    return one.coupling.empty() ? std::string{"-"} : printable(one.coupling);
  };
  const auto stable = [](const Compared& one) {
    return std::string{one.metrics.unstable ? "no" : "yes"};
  };
  std::string text = line_of("session", sessions, name) + line_of("coupling", sessions, coupling) +
                     line_of("stable", sessions, stable);
  for (const judge::Metric& metric : judge::metric_table()) {
    text += line_of(std::string{metric.name}, sessions, [&](const Compared& one) {
      return value_text(metric.value(one.metrics));
    });
  }
  return text;
}

}  // namespace palp::review
