#include "surgeon_site/session_end.h"

#include <string>

#include "common/record/notes.h"

namespace palp::surgeon {

using config::ExitCode;
using site_program::ExitStatus;

std::optional<ExitStatus> end_of_script(const SurgeonStatus& status) {
  if (!status.script.finished) return std::nullopt;
  const std::string outcome{to_string(status.script.outcome)};
  const auto cut_short = [&](const std::string& why, record::NoteCode code) {
    return ExitStatus{ExitCode::CutShort, outcome, why + std::string{record::to_string(code)}};
  };
  switch (status.script.outcome) {
    case ScriptOutcome::None:
    case ScriptOutcome::Completed:
      return ExitStatus{ExitCode::Done, outcome, ""};
    case ScriptOutcome::Interrupted:
      return cut_short("the link was lost and the script ends there", record::NoteCode::None);
    case ScriptOutcome::Refused:
      return cut_short("the site would not engage: ", status.refused);
    case ScriptOutcome::Stopped:
      return cut_short("the site was stopped: ", status.reason);
  }
  return std::nullopt;
}

ExitStatus end_of_time(const SurgeonStatus& status) {
  const std::string outcome = "duration reached";
  if (status.state == SiteState::Stopped) {
    return {ExitCode::CutShort,
            outcome,
            "the time is over and the site is stopped: " +
                std::string{record::to_string(status.reason)}};
  }
  if (status.peer_heard && status.peer_state == SiteState::Stopped) {
    return {ExitCode::CutShort, outcome, "the time is over and the patient's site is stopped"};
  }
  return {ExitCode::Done, outcome, ""};
}

std::optional<ExitStatus> StoppedPeerWatch::judge(const SurgeonStatus& status,
                                                  bool scripted,
                                                  TimePoint now) {
  const bool waits = scripted && status.state == SiteState::Parked && status.peer_heard &&
                     status.peer_state == SiteState::Stopped;
  if (!waits) {
    since_.reset();
    return std::nullopt;
  }
  if (!since_) since_ = now;
  if (now - *since_ < patience_) return std::nullopt;
  return ExitStatus{ExitCode::CutShort,
                    "peer stopped",
                    "the patient's site is stopped, and a script cannot reset it: press r there"};
}

}  // namespace palp::surgeon
