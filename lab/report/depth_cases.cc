#include "lab/report/depth_cases.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <type_traits>

#include "lab/report/checked_rows.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

constexpr std::string_view kMadeBy = "made_by";

/// Calls `visit(name, member)` for every member, in the order of the columns.
template <class Case, class Visit>
void each_of_case(Case& one, Visit&& visit) {
  visit("index", one.index);
  visit("inclusion", one.inclusion);
  visit("wide", one.wide);
  visit("prior", one.knowledge);
  visit("verdict", one.verdict);
  visit("depth_m", one.depth);
  visit("radius_m", one.radius);
  visit("ratio", one.ratio);
  visit("scale", one.scale);
  visit("estimate_m", one.estimate);
  visit("low_m", one.low);
  visit("high_m", one.high);
  visit("stddev_m", one.stddev);
  visit("assumed_low_m", one.assumed_low);
  visit("assumed_high_m", one.assumed_high);
  visit("excluded_m", one.excluded);
  visit("h_n", one.hash);
  visit("crb_m", one.bound);
  visit("signal_sigma", one.signal);
  visit("indentation_max_m", one.indentation);
  visit("strokes", one.strokes);
}

template <class Study, class Visit>
void each_of_study(Study& study, Visit&& visit) {
  visit("study_depths_m", study.depths);
  visit("study_count", study.count);
  visit("study_wide_count", study.wide_count);
  visit("study_repeats", study.repeats);
  visit("study_seed", study.seed);
  visit("study_estimator", study.estimator);
  visit("study_taps", study.taps);
  visit("study_reference_taps", study.reference_taps);
  visit("study_round_trip_s", study.round_trip);
  visit("study_loss", study.loss);
  visit("study_coupling", study.coupling);
}

/// The shortest digits that read back as the same number.
template <class Number>
std::string digits(Number value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

template <class Value>
std::string cell_of(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return value;  // a coupling's name
  } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
    std::string text;
    for (const double one : value) text += (text.empty() ? "" : ";") + digits(one);
    return text;
  } else if constexpr (std::is_enum_v<Value>) {
    return std::string{to_string(value)};
  } else if constexpr (std::is_same_v<Value, bool>) {
    return value ? "1" : "0";
  } else {
    return digits(value);
  }
}

template <class Number>
bool read_digits(std::string_view cell, Number& value) {
  const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return fault == std::errc{} && end == cell.data() + cell.size();
}

bool read_cell(std::string_view cell, std::vector<double>& values) {
  values.clear();
  while (!cell.empty()) {
    const std::size_t end = std::min(cell.find(';'), cell.size());
    if (!read_digits(cell.substr(0, end), values.emplace_back())) return false;
    cell.remove_prefix(std::min(end + 1, cell.size()));
  }
  return true;
}

template <class Value>
bool read_cell(std::string_view cell, Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    value = cell;
    return true;
  } else if constexpr (std::is_enum_v<Value>) {
    for (std::uint8_t i = 0; i < 3; ++i) {  // none has more enumerators
      value = static_cast<Value>(i);
      if (to_string(value) == cell) return true;
    }
    return false;
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = cell == "1";
    return value || cell == "0";
  } else {
    return read_digits(cell, value);
  }
}

std::vector<std::string_view> cells_in(std::string_view row) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = row.find(',');
    cells.push_back(row.substr(0, end));
    if (end == std::string_view::npos) return cells;
    row.remove_prefix(end + 1);
  }
}

/// A row without its line end and check; false: it is none.
bool read_row(std::string_view row, DepthStudy& study, DepthCase& one, std::string& made_by) {
  const std::vector<std::string_view> cells = cells_in(row);
  std::size_t next = 0;
  bool sound = true;
  const auto take = [&](const char*, auto& member) {
    sound = sound && next < cells.size() && read_cell(cells[next], member);
    ++next;
  };
  each_of_case(one, take);
  each_of_study(study, take);
  take("", made_by);
  return sound && next + 1 == cells.size();
}

std::string words_of_study(const DepthStudy& study) {
  std::string text;
  each_of_study(study, [&](const char* name, const auto& value) {
    text += (text.empty() ? "" : ", ") + std::string{name}.substr(6) + " " + cell_of(value);
  });
  return text;
}

/// As a cell that needs no quotes.
std::string plain_cell(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, ' ');
  return text;
}

}  // namespace

std::string depth_cases_header() {
  std::string text;
  const auto name_of = [&](const char* name, const auto&) { text.append(name) += ','; };
  const DepthCase one;
  each_of_case(one, name_of);
  const DepthStudy study;
  each_of_study(study, name_of);
  return text.append(kMadeBy).append(",").append(kCheckName) + '\n';
}

std::string depth_case_row(const DepthStudy& study,
                           const DepthCase& one,
                           const std::string& made_by) {
  std::string row;
  const auto add = [&](const char*, const auto& value) { row += cell_of(value) + ','; };
  each_of_case(one, add);
  each_of_study(study, add);
  return with_check(row + plain_cell(made_by)) + '\n';
}

bool is_depth_cases(std::string_view text) { return text.starts_with(depth_cases_header()); }

Result<void> read_depth_cases(std::string_view text, const std::string& name, DepthRows& rows) {
  if (!is_depth_cases(text)) {
    return fail(name + ": the first line is not that of a depth study's cases of this version");
  }
  std::size_t line = 1;
  for (text.remove_prefix(depth_cases_header().size()); !text.empty();) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string where = name + ": line " + std::to_string(++line);
    if (!holds_check(row)) {
      return fail(where + " was not written whole, or was changed: make its cases again");
    }
    DepthStudy study;
    DepthCase one;
    std::string made_by;
    if (!read_row(row, study, one, made_by)) return fail(where + " is not a row of a case");
    if (!rows.known) rows.study = study;
    rows.known = true;
    const std::string known = words_of_study(rows.study);
    if (std::string told = words_of_study(study); told != known) {
      told.append(") than the rest (").append(known).append(")");
      return fail(where + " is of another study (" + told);
    }
    rows.cases.push_back(one);
    rows.makers.insert(made_by);
  }
  return {};
}

Result<void> check_complete(DepthRows& rows) {
  std::stable_sort(rows.cases.begin(), rows.cases.end(), [](const auto& a, const auto& b) {
    return a.index < b.index;
  });
  std::vector<std::uint64_t> indices;
  indices.reserve(rows.cases.size());
  for (const DepthCase& one : rows.cases) indices.push_back(one.index);
  return check_all_there(indices, case_count(rows.study));
}

std::uint64_t digest_of(const std::vector<DepthCase>& cases) {
  Digest digest;
  for (const DepthCase& one : cases) {
    each_of_case(one, [&](const char*, const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
        digest.add(value);
      } else {
        digest.add(static_cast<std::uint64_t>(value));
      }
    });
  }
  return digest.value();
}

}  // namespace palp::lab
