#include "study/trial_row.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "common/config/number.h"
#include "common/core/printable.h"
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

// Places of the columns in a line.
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

Result<TrialRow> row_of(const std::vector<std::string_view>& cells, const Task& task) {
  std::array<double, Cell::Count> number{};
  for (const Cell::Place at : {Cell::Onset,
                               Cell::Duration,
                               Cell::ResponseTime,
                               Cell::Block,
                               Cell::Trial,
                               Cell::Track,
                               Cell::Level,
                               Cell::Interval,
                               Cell::Response,
                               Cell::Correct,
                               Cell::Mean,
                               Cell::Sd,
                               Cell::Taps,
                               Cell::Force,
                               Cell::Contact}) {
    const auto value = config::parse_number(cells[at]);
    if (!value || std::abs(*value) > kNumberMax) {
      return fail(std::string{row_columns()[at].name} + " is \"" + printable(cells[at]) +
                  "\", expected a number");
    }
    number[at] = *value;
  }
  const auto kind = kind_of(cells[Cell::Kind]);
  const auto whole = [&](Cell::Place at) { return static_cast<std::size_t>(number[at]); };
  if (!kind || number[Cell::Block] < 1 || number[Cell::Trial] < 1 || number[Cell::Track] < 0) {
    return fail("trial_type, block, trial or track is none");
  }
  for (const Cell::Place at : {Cell::Interval, Cell::Response}) {
    if (number[at] < 1 || number[at] > task.intervals) {
      return fail(std::string{row_columns()[at].name} + " is none of the trial's");
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
               .two_sided = task.two_sided};
  if (number[Cell::Correct] != (row.yes() ? 1 : 0)) {
    return fail("correct does not follow from interval and response");
  }
  return row;
}

}  // namespace

bool TrialRow::yes() const noexcept {
  return two_sided ? outcome.chosen == 1 : outcome.chosen == ask.stronger;
}

const std::vector<Column>& row_columns() {
  static const std::vector<Column> columns{
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
  return columns;
}

std::string row_header() {
  std::string text;
  for (const Column& one : row_columns()) {
    if (!text.empty()) text += '\t';
    text += one.name;
  }
  return text + '\n';
}

std::string row_text(const TrialRow& row) {
  const std::array<std::string, Cell::Count> cells{digits(row.outcome.onset),
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
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : "\t") + cell;
  return text + '\n';
}

Result<RowsFile> parse_rows(std::string_view text, const std::string& name, const Task& task) {
  RowsFile out;
  for (std::size_t number = 1, begin = 0;; ++number) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) break;
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (number == 1) {
      if (std::string{line} + '\n' != row_header()) {
        return fail(name + ": the first line does not name the columns of this version");
      }
    } else {
      const std::string where = name + ", line " + std::to_string(number);
      const auto cells = tab_cells(line);
      if (cells.size() != Cell::Count) return fail(where + " has another number of cells");
      auto row = row_of(cells, task);
      if (!row) return fail(where, row.error());
      out.rows.push_back(std::move(*row));
    }
    out.whole = begin;
  }
  return out;
}

}  // namespace palp::study
