#include "study/keep_command.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "common/config/report.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "study/data_set.h"
#include "study/exports.h"
#include "study/journal.h"
#include "study/replay_rows.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::ExitCode;
using config::ExitStatus;

ExitStatus refused(const Error& fault) { return config::refusal("palp-study", fault); }

/// The rows of one block.
std::vector<TrialRow> rows_of(const ParticipantRows& of, std::size_t block) {
  std::vector<TrialRow> out;
  std::ranges::copy_if(
      of.rows, std::back_inserter(out), [&](const TrialRow& row) { return row.block == block; });
  return out;
}

/// What is wrong with a participant's answers, a sentence each.
std::vector<std::string> faults_of(const Study& study,
                                   const AnswerTable& table,
                                   const ParticipantRows& of) {
  for (std::size_t participant = 0; participant < study.participants; ++participant) {
    if (participant_id(participant) != of.id) continue;
    std::vector<std::string> faults;
    std::size_t number = 0;
    for (const BlockPlan& plan : participant_plan(study, participant)) {
      Block block{study, table, plan};
      const auto told =
          replay_rows(block, rows_of(of, ++number), condition_code(study, plan.condition));
      if (!told) {
        faults.push_back(of.id + ", block " + std::to_string(number) + ": " + told.error().text);
      }
    }
    return faults;
  }
  return {of.id + " is none of the study's participants"};
}

}  // namespace

void declare_export(config::CommandLine& line, KeepFlags& flags) {
  line.argument("FOLDER", flags.folder, "of a study whose participants answered");
  line.required();
  line.choice("--format",
              flags.format,
              {std::begin(kExportFormats), std::end(kExportFormats)},
              "whose; the folder itself is a BIDS data set");
  line.output("--out", flags.out, "the file");
  line.required();
}

ExitStatus run_export(const KeepFlags& flags) {
  const auto planned = open_study(flags.folder);
  if (!planned) return refused(planned.error());
  const auto rows = read_rows(*planned);
  if (!rows) return refused(rows.error());
  const auto written = config::write_whole_file(flags.out, *export_text(flags.format, *rows));
  if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  return {ExitCode::Done, "written: " + flags.out + "\n"};
}

void declare_check(config::CommandLine& line, KeepFlags& flags) {
  line.argument("FOLDER", flags.folder, "of a planned study");
  line.required();
  line.footer("Exit code 1: something is not as registered, or an answer fits no trial.");
}

ExitStatus run_check(const KeepFlags& flags) {
  const auto planned = open_study(flags.folder);
  if (!planned) return refused(planned.error());
  const auto rows = read_rows(*planned);
  if (!rows) return refused(rows.error());
  const AnswerTable table = table_of(planned->study);
  std::vector<std::string> faults;
  if (!planned->registered) faults.push_back(planned->why_not);
  std::size_t answers = 0;
  for (const ParticipantRows& of : *rows) {
    answers += of.rows.size();
    for (std::string& one : faults_of(planned->study, table, of)) faults.push_back(std::move(one));
  }
  if (faults.empty()) {
    return {ExitCode::Done,
            "as registered; " + std::to_string(answers) + " answers of " +
                std::to_string(rows->size()) + " participants fit the schedule\n"};
  }
  std::string text;
  for (const std::string& one : faults) text += (text.empty() ? "palp-study: " : "; ") + one;
  return {ExitCode::Missed, text};
}

void declare_withdraw(config::CommandLine& line, KeepFlags& flags) {
  line.argument("FOLDER", flags.folder, "of a planned study");
  line.required();
  line.argument("PARTICIPANT", flags.participant, "sub-07");
  line.required();
  line.footer(
      "Deletes what the participant answered and the traces of it, and what fit, compare and "
      "report derived from all.\n"
      "Exports elsewhere are yours to delete.");
}

ExitStatus run_withdraw(const KeepFlags& flags) {
  const auto planned = open_study(flags.folder);
  if (!planned) return refused(planned.error());
  bool known = false;
  for (std::size_t i = 0; i < planned->study.participants; ++i) {
    known = known || participant_id(i) == flags.participant;
  }
  if (!known) {
    return {ExitCode::BadInput,
            "palp-study: " + printable(flags.participant) + " is none of the study's participants"};
  }
  const auto rows = read_rows(*planned);
  std::string kind = "person";
  if (rows && !rows->empty() && !rows->front().rows.empty()) kind = rows->front().rows.front().kind;
  const std::string path = planned->data.code("withdrawn.txt");
  const std::string before = read_whole_file(path).value_or(std::string{});
  auto log = Journal::open(path, before.size());
  if (!log) return refused(log.error());
  if (auto added = log->add(flags.participant + '\n'); !added) return refused(added.error());
  std::error_code fault;
  fs::remove_all(flags.folder + '/' + flags.participant, fault);
  if (!fault) fs::remove_all(planned->data.traces_folder(flags.participant), fault);
  if (!fault) fs::remove_all(planned->data.derived(""), fault);
  if (fault) return {ExitCode::CannotOpen, "palp-study: cannot delete: " + fault.message()};
  if (auto made = make_folder(planned->data.derived("")); !made) return refused(made.error());
  if (auto listed = planned->data.list_participants(kind); !listed) return refused(listed.error());
  return {ExitCode::Done,
          flags.participant + " is deleted; fit and report have to be made again\n"};
}

}  // namespace palp::study
