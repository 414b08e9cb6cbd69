#include "study/trial_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "common/config/number.h"
#include "common/core/printable.h"
#include "study/orders.h"
#include "study/tab_cells.h"

namespace palp::study {
namespace {

constexpr double kNumberMax = 1e9;  // [as the column]

std::string digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

std::optional<TrialKind> kind_of(std::string_view text) {
  for (const TrialKind kind : {TrialKind::Trial, TrialKind::Catch, TrialKind::Practice}) {
    if (to_string(kind) == text) return kind;
  }
  return std::nullopt;
}

// Places of the columns that all tasks have in a line.
struct Cell {
  enum Place : std::size_t {
    Onset,
    Duration,
    Kind,
    ResponseTime,
    Block,
    Trial,
    Track,
    Condition,
    Level,
    Interval,
    Response,
    Correct,
    Mean,
    Sd,
    Taps,
    Force,
    Contact,
    Who,
    Count
  };
};

// What a ranking has besides, and a search.
constexpr std::size_t kTau = Cell::Count;
constexpr std::size_t kError = Cell::Count;
constexpr std::size_t kPath = kError + 1;
constexpr std::size_t kForceMean = kError + 2;

constexpr double kMillimetres = 1e3;  // [1/m]
constexpr double kDigits = 1e-9;      // [m], that a row's digits cut off

constexpr std::array<std::string_view, 3> kWho{"person", "pilot", "simulated"};

constexpr const char* kNoHeader = "the first line does not name the columns of this version";

/// All but those of words.
Result<std::vector<double>> numbers_of(const std::vector<std::string_view>& cells,
                                       const std::vector<Column>& columns) {
  std::vector<double> numbers(cells.size());
  for (std::size_t at = 0; at < cells.size(); ++at) {
    if (at == Cell::Kind || at == Cell::Condition || at == Cell::Who) continue;
    const auto value = config::parse_number(cells[at]);
    if (!value || std::abs(*value) > kNumberMax) {
      return fail(std::string{columns[at].name} + " is \"" + printable(cells[at]) +
                  "\", expected a number");
    }
    numbers[at] = *value;
  }
  return numbers;
}

/// Which numbers are whole and from where, and what is none of the study's.
Result<void> check_cells(const std::vector<std::string_view>& cells,
                         const std::vector<double>& numbers,
                         const std::vector<Column>& columns,
                         const RowRules& rules) {
  const auto refused = [&](std::size_t at, const char* expected) {
    return fail(std::string{columns[at].name} + " is \"" + printable(cells[at]) + "\", expected " +
                expected);
  };
  for (const Cell::Place at : {Cell::Block,
                               Cell::Trial,
                               Cell::Track,
                               Cell::Interval,
                               Cell::Response,
                               Cell::Correct,
                               Cell::Taps}) {
    if (numbers[at] != std::floor(numbers[at])) return refused(at, "a whole number");
  }
  for (std::size_t at = 0; at < cells.size(); ++at) {
    const bool of_any_sign =
        at == Cell::Level || at == Cell::Mean || (rules.task.ranks && at == kTau);
    if (!of_any_sign && numbers[at] < 0) return refused(at, "no negative number");
  }
  if (numbers[Cell::Trial] < 1) return refused(Cell::Trial, "a number from 1");
  const auto block = static_cast<std::size_t>(numbers[Cell::Block]);
  if (block < 1 || block > rules.conditions || (rules.block > 0 && block != rules.block)) {
    return refused(Cell::Block, "the block of the file");
  }
  const std::string_view condition = cells[Cell::Condition];
  if (condition.size() != 1 || condition[0] < 'A' ||
      static_cast<std::size_t>(condition[0] - 'A') >= rules.conditions) {
    return refused(Cell::Condition, "a letter of the study");
  }
  if (!kind_of(cells[Cell::Kind])) return refused(Cell::Kind, "trial, catch or practice");
  if (std::ranges::find(kWho, cells[Cell::Who]) == std::end(kWho)) {
    return refused(Cell::Who, "person, pilot or simulated");
  }
  return {};
}

Result<TrialRow> row_of(const std::vector<std::string_view>& cells,
                        const std::vector<Column>& columns,
                        const RowRules& rules) {
  const Task& task = rules.task;
  const auto numbers = numbers_of(cells, columns);
  if (!numbers) return tl::unexpected(numbers.error());
  const std::vector<double>& number = *numbers;
  if (auto checked = check_cells(cells, number, columns, rules); !checked) {
    return tl::unexpected(checked.error());
  }
  const auto kind = kind_of(cells[Cell::Kind]);
  const auto whole = [&](Cell::Place at) { return static_cast<std::size_t>(number[at]); };
  for (const Cell::Place at : {Cell::Interval, Cell::Response}) {
    if (number[at] < 1 || number[at] > static_cast<double>(choices(task))) {
      return fail(std::string{columns[at].name} + " is none of the trial's");
    }
  }
  TrialRow row{.ask = {.kind = *kind,
                       .number = whole(Cell::Trial) - 1,
                       .track = whole(Cell::Track),
                       .level = number[Cell::Level],
                       .stronger = whole(Cell::Interval) - 1,
                       .decoy = 0},
               .outcome = {.chosen = whole(Cell::Response) - 1,
                           .onset = number[Cell::Onset],
                           .duration = number[Cell::Duration],
                           .response_time = number[Cell::ResponseTime],
                           .taps = static_cast<int>(number[Cell::Taps]),
                           .force_max = number[Cell::Force],
                           .contact = number[Cell::Contact]},
               .condition = std::string{cells[Cell::Condition]},
               .block = whole(Cell::Block),
               .kind = std::string{cells[Cell::Who]},
               .believed_mean = number[Cell::Mean],
               .believed_sd = number[Cell::Sd],
               .task = task};
  if (task.places > 0) {
    row.outcome.error = number[kError] / kMillimetres;
    row.outcome.path = number[kPath] / kMillimetres;
    row.outcome.force_mean = number[kForceMean];
  }
  if (number[Cell::Correct] != (row.yes() ? 1 : 0)) {
    return fail("correct does not follow from interval and response");
  }
  const double border = rules.within;
  const bool near = row.outcome.error < border + kDigits;
  const bool far = row.outcome.error > border - kDigits;
  if (border > 0 && !(row.yes() ? near : far)) return fail("error_mm does not agree with correct");
  const double tau = task.ranks ? kendall_tau(row.ask.stronger, row.outcome.chosen) : 0;
  if (task.ranks && std::abs(number[kTau] - tau) > 1e-8) {
    return fail("kendall_tau does not follow from interval and response");
  }
  return row;
}

}  // namespace

bool TrialRow::yes() const noexcept {
  return task.two_sided ? outcome.chosen == 1 : outcome.chosen == ask.stronger;
}

std::vector<Column> row_columns(const Task& task) {
  std::vector<Column> columns{
      {"onset", "when the trial began, since the participant's first", "s"},
      {"duration", "of the trial", "s"},
      {"trial_type", "trial, catch (the easiest level) or practice", ""},
      {"response_time", "from the question to the answer", "s"},
      {"block", "of the participant, from 1", ""},
      {"trial", "in the block, from 1", ""},
      {"track", "which of the interleaved tracks, from 0", ""},
      {"condition", "code; the key is kept apart", ""},
      {"level_ln", "logarithm of the ratio of stiffnesses", "1"},
      {"interval",
       "which held the stiffer tissue, from 1; bias: of easy trials only; detect: 2, something "
       "lies there",
       ""},
      {"response", "which was called the stiffest, from 1; detect: 2, yes", ""},
      {"correct", "1: right; bias: the second was called the stiffer; detect: yes", ""},
      {"posterior_mean", "of ln JND, by the track, after the answer", "1"},
      {"posterior_sd", "of the same", "1"},
      {"taps", "of all intervals", ""},
      {"force_max_n", "largest force the hand was given", "N"},
      {"contact_s", "time in contact", "s"},
      {"kind", "who answered: person, pilot (no approval was named) or simulated", ""}};
  if (task.delays) {
    columns[Cell::Level] = {"level_ms", "delay of the round trip, on top of the link's", "ms"};
    columns[Cell::Interval].meaning = "which was delayed, from 1";
    columns[Cell::Response].meaning = "which was called delayed, from 1";
  }
  if (task.ranks) {
    columns[Cell::Level].meaning =
        "logarithm of the ratio of stiffnesses of two neighbours in the order";
    columns[Cell::Interval].meaning =
        "the order, softest first: 1 to 6 for 1 2 3, 1 3 2, 2 1 3, 2 3 1, 3 1 2, 3 2 1";
    columns[Cell::Response].meaning = "the order that was said, likewise";
    columns.push_back({"kendall_tau", "of the two orders, -1 to 1", "1"});
  }
  if (task.places > 0) {
    columns[Cell::Interval].meaning = "1: something lies there";
    columns[Cell::Response].meaning = "1: the place that was said is near enough, 2: it is not";
    columns[Cell::Correct].meaning = "1: found";
    columns[Cell::ResponseTime].meaning = "of the search";
    columns.push_back({"error_mm", "from what was hidden to the place that was said", "mm"});
    columns.push_back({"path_mm", "of the tip along the surface", "mm"});
    columns.push_back({"force_mean_n", "of the tip while it touched", "N"});
  }
  return columns;
}

std::string row_header(const Task& task) {
  std::string text;
  for (const Column& one : row_columns(task)) {
    if (!text.empty()) text += '\t';
    text += one.name;
  }
  return text + '\n';
}

std::string row_text(const TrialRow& row) {
  std::vector<std::string> cells{digits(row.outcome.onset),
                                 digits(row.outcome.duration),
                                 std::string{to_string(row.ask.kind)},
                                 digits(row.outcome.response_time),
                                 std::to_string(row.block),
                                 std::to_string(row.ask.number + 1),
                                 std::to_string(row.ask.track),
                                 row.condition,
                                 digits(row.ask.level),
                                 std::to_string(row.ask.stronger + 1),
                                 std::to_string(row.outcome.chosen + 1),
                                 row.yes() ? "1" : "0",
                                 digits(row.believed_mean),
                                 digits(row.believed_sd),
                                 std::to_string(row.outcome.taps),
                                 digits(row.outcome.force_max),
                                 digits(row.outcome.contact),
                                 row.kind};
  if (row.task.ranks) cells.push_back(digits(kendall_tau(row.ask.stronger, row.outcome.chosen)));
  if (row.task.places > 0) {
    cells.push_back(digits(row.outcome.error * kMillimetres));
    cells.push_back(digits(row.outcome.path * kMillimetres));
    cells.push_back(digits(row.outcome.force_mean));
  }
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : "\t") + cell;
  return text + '\n';
}

Result<RowsFile> parse_rows(std::string_view text, const std::string& name, const RowRules& rules) {
  const Task& task = rules.task;
  RowsFile out;
  const std::vector<Column> columns = row_columns(task);
  for (std::size_t number = 1, begin = 0;; ++number) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) {
      if (number == 1 && !row_header(task).starts_with(text)) {
        return fail(name + ": " + kNoHeader);
      }
      break;
    }
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (number == 1) {
      if (std::string{line} + '\n' != row_header(task)) {
        return fail(name + ": " + kNoHeader + (line.ends_with('\r') ? ": it ends in CR" : ""));
      }
    } else {
      const std::string where = name + ", line " + std::to_string(number);
      const auto cells = tab_cells(line);
      if (cells.size() != columns.size()) return fail(where + " has another number of cells");
      auto row = row_of(cells, columns, rules);
      if (!row) return fail(where, row.error());
      out.rows.push_back(std::move(*row));
    }
    out.whole = begin;
  }
  return out;
}

}  // namespace palp::study
