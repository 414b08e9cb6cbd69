#include "study/keep_command.h"

#include <filesystem>
#include <vector>

#include "common/config/report.h"
#include "common/core/printable.h"
#include "study/data_set.h"
#include "study/exports.h"
#include "study/standing.h"
#include "study/withdrawn.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::ExitCode;
using config::ExitStatus;

ExitStatus refused(const Error& fault) { return config::refusal("palp-study", fault); }

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
  if (auto may = planned->data.may_write(flags.out); !may) return refused(may.error());
  const auto rows = read_rows(*planned);
  if (!rows) return refused(rows.error());
  const auto excluded = exclusions(planned->study, *rows);
  const auto written =
      config::write_whole_file(flags.out, *export_text(flags.format, *rows, excluded));
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
  auto replay = replay_study(*planned, *rows);
  if (!replay) return refused(replay.error());
  const auto looked = early_look(planned->data);
  if (!looked) return refused(looked.error());
  std::vector<std::string>& faults = replay->faults;
  if (!planned->registered) faults.insert(faults.begin(), planned->why_not);
  if (faults.empty()) {
    std::size_t answers = 0;
    for (const ParticipantRows& of : *rows) answers += of.rows.size();
    return {ExitCode::Done,
            "as registered; " + std::to_string(answers) + " answers of " +
                std::to_string(rows->size()) + " participants fit the schedule" + *looked + "\n"};
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
      "Exports are yours to delete: those in the folder are named.");
}

ExitStatus run_withdraw(const KeepFlags& flags) {
  const auto planned = open_without_key(flags.folder);
  if (!planned) return refused(planned.error());
  bool known = false;
  for (std::size_t i = 0; i < planned->study.participants; ++i) {
    known = known || participant_id(i) == flags.participant;
  }
  if (!known) {
    return {ExitCode::BadInput,
            "palp-study: " + printable(flags.participant) + " is none of the study's participants"};
  }
  if (auto added = add_withdrawn(planned->data, flags.participant); !added) {
    return refused(added.error());
  }
  if (auto gone = delete_participant(planned->data, flags.participant); !gone) {
    return refused(gone.error());
  }
  std::error_code fault;
  fs::remove_all(planned->data.derived(""), fault);
  if (fault) return {ExitCode::CannotOpen, "palp-study: cannot delete: " + fault.message()};
  if (auto made = make_folder(planned->data.derived("")); !made) return refused(made.error());
  if (auto listed = list_participants(*planned); !listed) return refused(listed.error());
  const auto left = files_with(planned->data, flags.participant);
  if (!left) {
    return refused({flags.participant +
                        " is deleted, but not all files were searched for it: " + left.error().text,
                    true});
  }
  std::string text = flags.participant + " is deleted; fit and report have to be made again\n";
  for (const std::string& path : *left) {
    text += printable(path) + " still names " + flags.participant + ": it is yours to delete\n";
  }
  return {ExitCode::Done, text};
}

}  // namespace palp::study
