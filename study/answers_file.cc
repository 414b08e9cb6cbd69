#include "study/answers_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "common/config/number.h"
#include "common/core/byte_order_mark.h"
#include "common/core/printable.h"
#include "study/tab_cells.h"

namespace palp::study {
namespace {

constexpr double kLevelMax = 10;      // [-], 22,000 times as stiff
constexpr double kDelayMax = 10'000;  // [ms]

/// Takes the first line off, without its end.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

struct Columns {
  std::size_t count{};
  std::size_t level{};
  std::size_t correct{};
  std::optional<std::size_t> condition;
  std::optional<std::size_t> kind;
  bool delays{};
};

Result<Columns> columns_of(std::string_view header, const std::string& name) {
  const auto names = tab_cells(header);
  const auto find = [&](std::string_view wanted) -> std::optional<std::size_t> {
    const auto at = std::ranges::find(names, wanted);
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
  };
  const auto delay = find("level_ms");
  const auto ratio = find("level_ln");
  const auto level = delay ? delay : ratio;
  const auto correct = find("correct");
  if (delay && ratio)
    return fail(name + " has the columns 'level_ln' and 'level_ms', expected one");
  for (const std::string_view one : {"kendall_tau", "error_mm"}) {
    if (!find(one)) continue;
    return fail(name + " has the column '" + std::string{one} +
                "': it is of a ranking or a search, fit the folder of its study");
  }
  if (!level || !correct) {
    return fail(name + " has no column '" + (level ? "correct" : "level_ln") +
                "' in its first line; columns are separated by tabs");
  }
  for (const std::string_view one :
       {"level_ln", "level_ms", "correct", "condition", "trial_type"}) {
    if (std::ranges::count(names, one) > 1) {
      return fail(name + " names the column '" + std::string{one} + "' twice");
    }
  }
  return Columns{
      names.size(), *level, *correct, find("condition"), find("trial_type"), delay.has_value()};
}

}  // namespace

Result<AnswersFile> parse_answers(std::string_view text, const std::string& name) {
  text = without_byte_order_mark(text);
  const auto columns = columns_of(take_line(text), name);
  if (!columns) return tl::unexpected(columns.error());
  AnswersFile file{.conditions = {}, .delays = columns->delays};
  std::vector<ConditionAnswers>& out = file.conditions;
  for (std::size_t number = 2; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    if (line.empty()) continue;
    const std::string where = name + ", line " + std::to_string(number);
    const auto cells = tab_cells(line);
    if (cells.size() != columns->count) {
      return fail(where + " has " + std::to_string(cells.size()) + " cells, expected " +
                  std::to_string(columns->count));
    }
    if (columns->kind && cells[*columns->kind] == "practice") continue;
    const std::string_view correct = cells[columns->correct];
    if (correct == "n/a") continue;
    const auto level = config::parse_number(cells[columns->level]);
    if (!level) {
      return fail(where + ": level_" + level_suffix({.delays = columns->delays}) + " is \"" +
                  printable(cells[columns->level]) + "\", expected a number");
    }
    const double level_max = columns->delays ? kDelayMax : kLevelMax;
    if (std::abs(*level) > level_max) {
      return fail(where + ": level_" + level_suffix({.delays = columns->delays}) + " is " +
                  printable(cells[columns->level]) + ", expected no more than " +
                  config::number_text(level_max) + " of either sign");
    }
    if (correct != "0" && correct != "1") {
      return fail(where + ": correct is \"" + printable(correct) + "\", expected 0, 1 or n/a");
    }
    const std::string_view condition =
        columns->condition ? cells[*columns->condition] : std::string_view{};
    auto group = std::ranges::find(out, condition, &ConditionAnswers::condition);
    if (group == out.end()) {
      out.push_back({std::string{condition}, {}});
      group = std::prev(out.end());
    }
    group->answers.push_back({*level, correct == "1" ? std::size_t{1} : 0, 1});
  }
  if (out.empty()) return fail(name + " holds no answered trial");
  for (ConditionAnswers& one : out) one.answers = pooled(one.answers);
  return file;
}

}  // namespace palp::study
