#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "study/study_file.h"
#include "study/trial_row.h"

/// A study's folder, in the form of BIDS: who finds what where.
///
///     dataset_description.json README participants.tsv participants.json task-TASK_beh.json
///     sub-01/ses-01/beh/sub-01_ses-01_task-TASK_run-01_beh.tsv     a line for each trial
///     sourcedata/sub-01/run-01_part-1_{surgeon,patient}.mcap       traces, of real sites alone
///     code/study.textproto schedule.json plan.json PREREGISTRATION.md key.json
///     code/observer.json run.lock withdrawn.txt unblinded.txt      as far as they came to be
///     derivatives/palp-study/                                      what fit, compare, report say
namespace palp::study {

inline constexpr std::size_t kTableMax = std::size_t{64} << 20;  ///< [bytes], of any file here

/// "sub-07"; `participant` from 0.
[[nodiscard]] std::string participant_id(std::size_t participant);

/// Where everything lies below a folder.
struct DataSet {
  std::string folder{};

  [[nodiscard]] std::string code(const std::string& name) const;
  [[nodiscard]] std::string derived(const std::string& name) const;
  [[nodiscard]] std::string trials_folder(const std::string& id) const;
  /// Session files of a participant's real sessions.
  [[nodiscard]] std::string traces_folder(const std::string& id) const;
  /// Of a participant's block, from 1.
  [[nodiscard]] std::string trials(const std::string& id,
                                   std::string_view task,
                                   std::size_t block) const;
  /// Identifiers of those whose folders are there, in order, of the study or not. A link is an
  /// error. Errors are CannotOpen here and below.
  [[nodiscard]] Result<std::vector<std::string>> participants() const;
  /// For the participant's answers; refused where a link leads elsewhere.
  [[nodiscard]] Result<void> make_trials_folder(const std::string& id) const;
  /// Whether an output may be written there: not over what the folder itself consists of. Below
  /// the folder derivatives/ alone is free.
  [[nodiscard]] Result<void> may_write(const std::string& path) const;
};

/// Whether an output may be written there: in no study's folder, whose derivatives/ alone is free.
[[nodiscard]] Result<void> beside_studies(const std::string& path);

/// A study that was planned, with what registration says of it.
struct PlannedStudy {
  DataSet data{};
  Study study{};  ///< its conditions in the order of their letters
  std::string study_text{};
  /// Study file, schedule, key and pre-registration are still those that were registered.
  bool registered{};
  std::string why_not{};  ///< !registered
};
/// Needs the key of the letters.
[[nodiscard]] Result<PlannedStudy> open_study(const std::string& folder);
/// For what goes by no letter, and must be possible without the key: conditions are as the study's
/// file has them, and nothing is said of the registration.
[[nodiscard]] Result<PlannedStudy> open_without_key(const std::string& folder);

/// All answers of a participant.
struct ParticipantRows {
  std::string id{};
  std::vector<TrialRow> rows;
};
/// Of the study's participants whose folders are there, without those who withdrew.
[[nodiscard]] Result<std::vector<ParticipantRows>> read_rows(const PlannedStudy& planned);
/// Folders of participants whom the study does not have.
[[nodiscard]] Result<std::vector<std::string>> strangers(const PlannedStudy& planned);

/// What is to be found in a cell of a block's file.
[[nodiscard]] RowRules row_rules(const Study& study, std::size_t block);

/// participants.tsv follows what is there: who answered is what the rows say, and columns that
/// somebody added stay.
[[nodiscard]] Result<void> list_participants(const PlannedStudy& planned);

/// A regular file's content; nothing where there is none. Any other failure is an error, so that
/// what cannot be read is not taken for what is not there.
[[nodiscard]] Result<std::optional<std::string>> read_if_there(const std::string& path);

/// SHA-256 in hexadecimal digits.
[[nodiscard]] std::string fingerprint(std::string_view text);

/// A folder and those above it. The error is a CannotOpen.
[[nodiscard]] Result<void> make_folder(const std::string& path);

}  // namespace palp::study
