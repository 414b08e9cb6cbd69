#include "study/standing.h"

#include <algorithm>

#include "common/core/printable.h"
#include "study/block.h"
#include "study/journal.h"
#include "study/replay_rows.h"
#include "study/who_answers.h"
#include "study/withdrawn.h"

namespace palp::study {
namespace {

constexpr std::string_view kEarly = ", before all had answered";

/// The rows of one block.
std::vector<TrialRow> rows_of(const ParticipantRows& of, std::size_t block) {
  std::vector<TrialRow> out;
  std::ranges::copy_if(
      of.rows, std::back_inserter(out), [&](const TrialRow& row) { return row.block == block; });
  return out;
}

/// Tells the participant's answers to the blocks: faults are added.
void replay_participant(const Study& study,
                        const AnswerTable& table,
                        std::size_t participant,
                        const ParticipantRows& of,
                        StudyReplay& out) {
  std::size_t number = 0;
  bool done = true;
  bool excluded = false;
  for (const BlockPlan& plan : participant_plan(study, participant)) {
    const std::vector<TrialRow> rows = rows_of(of, ++number);
    const std::string where = of.id + ", block " + std::to_string(number);
    if (!rows.empty() && (excluded || !done)) {
      out.faults.push_back(where + " was begun before the one before it was done");
    }
    Block block{study, table, plan};
    if (auto told = replay_rows(block, rows, condition_code(plan.condition)); !told) {
      out.faults.push_back(where + ": " + told.error().text);
      done = false;
      continue;
    }
    done = done && (excluded || block.done());
    excluded = excluded || block.excluded();
  }
  if (done) ++out.done;
}

/// Sentences on those who should not be there.
Result<std::vector<std::string>> faults_of_folders(const PlannedStudy& planned) {
  std::vector<std::string> out;
  const auto others = strangers(planned);
  if (!others) return tl::unexpected(others.error());
  for (const std::string& id : *others) {
    out.push_back(printable(id) + " is none of the study's participants");
  }
  const auto left = withdrawn_with_data(planned.data);
  if (!left) return tl::unexpected(left.error());
  for (const std::string& id : *left) {
    out.push_back(printable(id) + " has withdrawn and is still there: palp-study withdraw deletes");
  }
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& one : words) out += (out.empty() ? "" : " and ") + one;
  return out;
}

/// Empty: all is as it was registered, and everybody has answered.
Result<std::string> why_not(const PlannedStudy& planned, const std::vector<ParticipantRows>& rows) {
  if (!planned.registered) return planned.why_not;
  const auto replay = replay_study(planned, rows);
  if (!replay) return tl::unexpected(replay.error());
  if (!replay->faults.empty()) {
    const std::size_t more = replay->faults.size() - 1;
    return replay->faults.front() + (more > 0 ? ", and " + std::to_string(more) + " more" : "");
  }
  const auto gone = withdrawn_participants(planned.data);
  if (!gone) return tl::unexpected(gone.error());
  std::size_t wanted = 0;
  for (std::size_t i = 0; i < planned.study.participants; ++i) {
    if (std::ranges::find(*gone, participant_id(i)) == gone->end()) ++wanted;
  }
  if (replay->done < wanted) {
    return std::to_string(replay->done) + " of " + std::to_string(wanted) +
           " registered participants have answered all that they are asked";
  }
  return std::string{};
}

}  // namespace

Result<StudyReplay> replay_study(const PlannedStudy& planned,
                                 const std::vector<ParticipantRows>& rows) {
  auto faults = faults_of_folders(planned);
  if (!faults) return tl::unexpected(faults.error());
  StudyReplay out{.faults = std::move(*faults), .done = 0};
  const std::vector<std::string> kinds = kinds_of(rows);
  const auto bound = bound_kind(planned.data);
  if (!bound) return tl::unexpected(bound.error());
  if (kinds.size() > 1) {
    out.faults.push_back("answers of kinds " + joined(kinds) + " are mixed");
  } else if (!kinds.empty() && kinds.front() != *bound) {
    out.faults.push_back("answers are of kind " + kinds.front() +
                         ", which is not what code/observer.json says");
  }
  const AnswerTable table = table_of(planned.study);
  for (std::size_t i = 0; i < planned.study.participants; ++i) {
    const auto of = std::ranges::find(rows, participant_id(i), &ParticipantRows::id);
    if (of != rows.end()) replay_participant(planned.study, table, i, *of, out);
  }
  return out;
}

Result<std::string> standing(const PlannedStudy& planned,
                             const std::vector<ParticipantRows>& rows) {
  auto why = why_not(planned, rows);
  if (!why) return why;
  auto looked = early_look(planned.data);
  if (!looked) return looked;
  const std::vector<std::string> kinds = kinds_of(rows);
  const std::string kind = kinds.size() == 1 ? kinds.front() : "";
  if (kind == "simulated") return "simulated: " + (why->empty() ? "as registered" : *why) + *looked;
  if (!why->empty()) return "exploratory: " + *why + *looked;
  if (kind != "person" || planned.study.ethics.body.empty()) {
    return "exploratory: a pilot, for no approval was named" + *looked;
  }
  if (planned.study.primary.empty()) {
    return "exploratory: no primary comparison was registered" + *looked;
  }
  return "confirmatory: all is as registered, and everybody has answered" + *looked;
}

Result<void> log_unblinding(const PlannedStudy& planned, const std::vector<ParticipantRows>& rows) {
  std::size_t answers = 0;
  std::size_t participants = 0;
  for (const ParticipantRows& of : rows) {
    answers += of.rows.size();
    if (!of.rows.empty()) ++participants;
  }
  const auto why = why_not(planned, rows);
  if (!why) return tl::unexpected(why.error());
  auto log = Journal::open(planned.data.code("unblinded.txt"));
  if (!log) return tl::unexpected(log.error());
  return log->add("unblinded after " + std::to_string(answers) + " answers of " +
                  std::to_string(participants) + " participants" +
                  (why->empty() ? "" : std::string{kEarly}) + '\n');
}

Result<std::string> early_look(const DataSet& data) {
  const auto text = read_if_there(data.code("unblinded.txt"));
  if (!text) return tl::unexpected(text.error());
  const std::string log = text->value_or("");
  const std::size_t end = log.find(kEarly);
  if (end == std::string::npos) return std::string{};
  const std::size_t begin = log.rfind('\n', end);
  return "; " +
         printable(log.substr(begin == std::string::npos ? 0 : begin + 1,
                              end - (begin == std::string::npos ? 0 : begin + 1))) +
         std::string{kEarly};
}

}  // namespace palp::study
