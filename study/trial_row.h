#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "study/block.h"

/// Trials as lines of a table, as BIDS has it: what is written down before the next trial begins.
/// Pure.
namespace palp::study {

/// What came out of a trial.
struct TrialOutcome {
  std::size_t chosen{};    ///< the interval, or what was chosen, from 0; a search: 0 found, 1 not
  double onset{};          ///< [s], since the participant's first trial began
  double duration{};       ///< [s]
  double response_time{};  ///< [s]
  int taps{};              ///< of all intervals
  double force_max{};      ///< [N], magnitude of what the hand was given
  double contact{};        ///< [s]
  // Of a search.
  double error{};       ///< [m], from what was hidden to the place that was said
  double path{};        ///< [m], of the tip along the surface
  double force_mean{};  ///< [N], of the tip while it touched
};

struct TrialRow {
  TrialAsk ask{};
  TrialOutcome outcome{};
  std::string condition{};  ///< code
  std::size_t block{};      ///< of the participant, from 1
  std::string kind{};       ///< "person", "pilot" or "simulated"
  double believed_mean{};   ///< [-], of ln JND, by the trial's track after the answer
  double believed_sd{};     ///< [-]
  Task task{};

  /// Right, or found; at a two-sided task "the second is stiffer", or "yes".
  [[nodiscard]] bool yes() const noexcept;
};

/// The first line, with its end.
[[nodiscard]] std::string row_header(const Task& task);
[[nodiscard]] std::string row_text(const TrialRow& row);

/// The rows of a file as row_text() wrote them. A last line without its end was never finished:
/// it is left out, and `whole` says how many bytes stand before it.
struct RowsFile {
  std::vector<TrialRow> rows;
  std::size_t whole{};  ///< [bytes]
};

/// What a row may hold.
struct RowRules {
  Task task{};
  std::size_t conditions{kConditionsMax};  ///< of the study
  std::size_t block{};                     ///< of all rows, from 1; 0: any
  double within{};                         ///< [m], of a search: found; 0: not looked at
};
/// Every cell is looked at. A file that has content, but neither the header of this version nor
/// the beginning of it, is refused.
[[nodiscard]] Result<RowsFile> parse_rows(std::string_view text,
                                          const std::string& name,
                                          const RowRules& rules);

/// Column by column: name, meaning, unit: for task-*_beh.json. What is common to all tasks comes
/// first.
struct Column {
  std::string_view name;
  std::string_view meaning;
  std::string_view unit;  ///< empty: none
};
[[nodiscard]] std::vector<Column> row_columns(const Task& task);

}  // namespace palp::study
