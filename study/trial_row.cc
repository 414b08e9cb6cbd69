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
constexpr std::size_t kOnset = 0;
constexpr std::size_t kDuration = 1;
constexpr std::size_t kKind = 2;
constexpr std::size_t kResponseTime = 3;
constexpr std::size_t kBlock = 4;
constexpr std::size_t kTrial = 5;
constexpr std::size_t kTrack = 6;
constexpr std::size_t kCondition = 7;
constexpr std::size_t kLevel = 8;
constexpr std::size_t kInterval = 9;
constexpr std::size_t kResponse = 10;
constexpr std::size_t kCorrect = 11;
constexpr std::size_t kMean = 12;
constexpr std::size_t kSd = 13;
constexpr std::size_t kTaps = 14;
constexpr std::size_t kForce = 15;
constexpr std::size_t kContact = 16;
constexpr std::size_t kWho = 17;
constexpr std::size_t kCount = 18;

Result<TrialRow> row_of(const std::vector<std::string_view>& cells, const Task& task) {
  std::array<double, kCount> number{};
  for (const std::size_t at : {kOnset,
                               kDuration,
                               kResponseTime,
                               kBlock,
                               kTrial,
                               kTrack,
                               kLevel,
                               kInterval,
                               kResponse,
                               kCorrect,
                               kMean,
                               kSd,
                               kTaps,
                               kForce,
                               kContact}) {
    const auto value = config::parse_number(cells[at]);
    if (!value || std::abs(*value) > kNumberMax) {
      return fail(std::string{row_columns()[at].name} + " is \"" + printable(cells[at]) +
                  "\", expected a number");
    }
    number[at] = *value;
  }
  const auto kind = kind_of(cells[kKind]);
  const auto whole = [&](std::size_t at) { return static_cast<std::size_t>(number[at]); };
  if (!kind || number[kBlock] < 1 || number[kTrial] < 1 || number[kTrack] < 0) {
    return fail("trial_type, block, trial or track is none");
  }
  for (const std::size_t at : {kInterval, kResponse}) {
    if (number[at] < 1 || number[at] > task.intervals) {
      return fail(std::string{row_columns()[at].name} + " is none of the trial's");
    }
  }
  TrialRow row{.ask = {.kind = *kind,
                       .number = whole(kTrial) - 1,
                       .track = whole(kTrack),
                       .level = number[kLevel],
                       .stronger = whole(kInterval) - 1,
                       .decoy = 0},
               .outcome = {.chosen = whole(kResponse) - 1,
                           .onset = number[kOnset],
                           .duration = number[kDuration],
                           .response_time = number[kResponseTime],
                           .taps = static_cast<int>(number[kTaps]),
                           .force_max = number[kForce],
                           .contact = number[kContact]},
               .condition = std::string{cells[kCondition]},
               .block = whole(kBlock),
               .kind = std::string{cells[kWho]},
               .believed_mean = number[kMean],
               .believed_sd = number[kSd],
               .two_sided = task.two_sided};
  if (number[kCorrect] != (row.yes() ? 1 : 0)) {
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
      {"interval", "which held the stiffer tissue, from 1; two-sided: of easy trials only", ""},
      {"response", "which was called the stiffest, from 1", ""},
      {"correct", "1: right; two-sided tasks: the second was called the stiffer", ""},
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
  const std::array<std::string, kCount> cells{digits(row.outcome.onset),
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
      if (cells.size() != kCount) return fail(where + " has another number of cells");
      auto row = row_of(cells, task);
      if (!row) return fail(where, row.error());
      out.rows.push_back(std::move(*row));
    }
    out.whole = begin;
  }
  return out;
}

}  // namespace palp::study
