#include "study/run_command.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "study/journal.h"
#include "study/replay_rows.h"
#include "study/who_answers.h"
#include "study/withdrawn.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;

/// What all participants of a run share.
struct Runner {
  const PlannedStudy& planned;
  const AnswerTable& table;
  const Observer& observer;
  const std::function<void(const std::string&)>& say;
  bool each{};
  std::string kind{};  ///< as a row has it
};

/// As a row has it, so that a run that was cut short goes on from the very same number.
double milliseconds(double value) { return std::round(value * 1e3) / 1e3; }

struct BlockEnd {
  double clock{};  ///< [s], since the participant's first trial
  bool excluded{};
  std::size_t answered{};  ///< in this run
};

/// Nobody who has withdrawn is asked on; what was written since goes too.
Result<void> refuse_withdrawn(const Runner& runner, const std::string& id) {
  const auto gone = has_withdrawn(runner.planned.data, id);
  if (!gone) return tl::unexpected(gone.error());
  if (!*gone) return {};
  if (auto deleted = delete_participant(runner.planned.data, id); !deleted) return deleted;
  return fail(id + " has withdrawn: nothing more is asked");
}

/// The file of a block, locked, with the rows of earlier runs in it.
struct OpenBlock {
  Journal journal;
  std::vector<TrialRow> before;
};
Result<OpenBlock> open_block(const Runner& runner, const std::string& id, std::size_t number) {
  const Study& study = runner.planned.study;
  const std::string path = runner.planned.data.trials(id, task_name(study), number);
  if (auto wanted = refuse_withdrawn(runner, id); !wanted) return tl::unexpected(wanted.error());
  if (auto made = runner.planned.data.make_trials_folder(id); !made) {
    return tl::unexpected(made.error());
  }
  auto journal = Journal::open(path);
  if (!journal) return tl::unexpected(journal.error());
  // Who withdrew just before the file was made would have it all the same.
  if (auto wanted = refuse_withdrawn(runner, id); !wanted) return tl::unexpected(wanted.error());
  auto before = parse_rows(journal->text(), path, row_rules(study, number));
  if (!before) return tl::unexpected(before.error());
  if (auto cut = journal->cut(before->whole); !cut) return tl::unexpected(cut.error());
  if (before->whole == 0) {
    if (auto added = journal->add(row_header(study.task)); !added) {
      return tl::unexpected(added.error());
    }
  }
  return OpenBlock{std::move(*journal), std::move(before->rows)};
}

Result<BlockEnd> run_block(const Runner& runner,
                           std::size_t participant,
                           std::size_t number,
                           const BlockPlan& plan,
                           double clock) {
  const Study& study = runner.planned.study;
  const std::string id = participant_id(participant);
  const std::string code = condition_code(plan.condition);
  auto opened = open_block(runner, id, number);
  if (!opened) return tl::unexpected(opened.error());
  auto& [journal, before] = *opened;
  Block block{study, runner.table, plan};
  if (auto told = replay_rows(block, before, code); !told) {
    return fail(runner.planned.data.trials(id, task_name(study), number), told.error());
  }
  BlockEnd end{.clock = clock, .excluded = false, .answered = 0};
  if (!before.empty()) {
    const TrialOutcome& last = before.back().outcome;
    end.clock = milliseconds(last.onset + last.duration);
  }
  while (!block.done()) {
    if (auto wanted = refuse_withdrawn(runner, id); !wanted) return tl::unexpected(wanted.error());
    const TrialAsk ask = block.next();
    const auto outcome = runner.observer({participant, plan.condition}, ask);
    // A session may have been begun for somebody who withdrew in the rest before it.
    if (auto wanted = refuse_withdrawn(runner, id); !wanted) return tl::unexpected(wanted.error());
    if (!outcome) return tl::unexpected(outcome.error());
    TrialRow row{.ask = ask,
                 .outcome = *outcome,
                 .condition = code,
                 .block = number,
                 .kind = runner.kind,
                 .believed_mean = 0,
                 .believed_sd = 0,
                 .task = study.task};
    row.outcome.onset = end.clock;
    row.outcome.duration = milliseconds(row.outcome.duration);
    block.told(row.yes());
    const Marginal believed = block.believed(ask.track);
    row.believed_mean = believed.mean;
    row.believed_sd = believed.sd;
    if (auto added = journal.add(row_text(row)); !added) return tl::unexpected(added.error());
    end.clock = milliseconds(end.clock + row.outcome.duration);
    ++end.answered;
    if (runner.each) {
      runner.say(id + " block " + std::to_string(number) + " trial " +
                 std::to_string(ask.number + 1) + " answered\n");
    }
  }
  end.excluded = block.excluded();
  return end;
}

/// @returns trials answered now; nothing: the participant withdrew before.
Result<std::optional<std::size_t>> run_participant(const Runner& runner, std::size_t participant) {
  const Study& study = runner.planned.study;
  const auto gone = has_withdrawn(runner.planned.data, participant_id(participant));
  if (!gone) return tl::unexpected(gone.error());
  if (*gone) return std::nullopt;
  std::size_t answered = 0;
  double clock = 0;
  std::size_t number = 0;
  for (const BlockPlan& plan : participant_plan(study, participant)) {
    const auto end = run_block(runner, participant, ++number, plan, clock);
    if (!end) return tl::unexpected(end.error());
    answered += end->answered;
    if (end->excluded) break;
    clock = milliseconds(end->clock + study.rest);
  }
  return answered;
}

/// Without an approval answers of people are a pilot's.
std::string kind_of(const RunFlags& flags, const Study& study) {
  if (flags.observer != kPerson) return "simulated";
  return study.ethics.body.empty() ? "pilot" : "person";
}

/// Those that are to go through the study, without those who withdrew.
Result<std::vector<std::size_t>> chosen(const RunFlags& flags, const PlannedStudy& planned) {
  const std::size_t count = planned.study.participants;
  if (flags.participant && *flags.participant > count) {
    return fail("--participant is " + std::to_string(*flags.participant) + ", the study has " +
                std::to_string(count));
  }
  const auto withdrawn = withdrawn_participants(planned.data);
  if (!withdrawn) return tl::unexpected(withdrawn.error());
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < count; ++i) {
    if (flags.participant && *flags.participant != i + 1) continue;
    if (std::ranges::find(*withdrawn, participant_id(i)) == withdrawn->end()) {
      out.push_back(i);
    } else if (flags.participant) {
      return fail(participant_id(i) + " has withdrawn");
    }
  }
  return out;
}

/// Answers of one folder are of one kind.
Result<RunLock> bind_to(const RunFlags& flags, const PlannedStudy& planned) {
  WhoAnswers who{.kind = kind_of(flags, planned.study), .observer = {}, .people = {}};
  if (flags.observer != kPerson) {
    who.observer = flags.observer;
    who.people = flags.people;
  }
  return bind_folder(planned, who);
}

}  // namespace

void declare_run(config::CommandLine& line, RunFlags& flags) {
  line.argument("FOLDER", flags.folder, "of a planned study");
  line.required();
  line.whole("--participant",
             flags.participant,
             {.min = 1, .max = 999},
             "this one alone; otherwise all, those who withdrew left out");
  line.choice(
      "--observer",
      flags.observer,
      {"formula", "felt", std::string{kPerson}},
      "who answers: a formula that knows no condition, somebody who feels whole sessions in "
      "virtual time, or a person at the page of real sites, --participant");
  line.number("--weber",
              flags.people.weber,
              {.min = 0.01, .max = 1},
              "median Weber fraction of the observers with their own finger");
  line.number("--spread",
              flags.people.spread,
              {.min = 0, .max = 1},
              "standard deviation of ln JND from one to the next");
  line.number("--lapse", flags.people.lapse, {.min = 0, .max = 0.5}, "share of answers guessed");
  line.text(
      "--master", flags.hand.master, "NAME", "of a person: pointer, or a device of palp-surgeon");
  line.text("--devices",
            flags.hand.devices,
            "FILE",
            "of a person: file that says how a master is built in");
  line.whole("--monitor-port",
             flags.hand.monitor_port,
             {.min = 0, .max = 65535},
             "of a person: TCP port of the page; 0: any free one");
  line.toggle("--each", flags.each, "print a line for each answered trial");
  line.footer(
      "Goes on where an earlier run stood: every answer is on the disk before the next trial "
      "begins.\nScreen and lines name neither condition nor level.");
}

ExitStatus run_run(const RunFlags& flags,
                   const MakeObserver& make_observer,
                   const ForEachIndex& for_each_index,
                   const std::function<void(const std::string&)>& say) {
  const auto planned = open_study(flags.folder);
  if (!planned) return config::refusal("palp-study", planned.error());
  if (flags.observer == kPerson && !flags.participant) {
    return {ExitCode::BadInput, "palp-study: --observer person needs --participant: one at a time"};
  }
  if (!planned->registered) {
    return {ExitCode::BadInput, "palp-study: nobody is asked: " + planned->why_not};
  }
  const auto who = chosen(flags, *planned);
  if (!who) return config::refusal("palp-study", who.error());
  const auto bound = bind_to(flags, *planned);
  if (!bound) return config::refusal("palp-study", bound.error());
  const auto observer = make_observer(planned->study);
  if (!observer) return config::refusal("palp-study", observer.error());
  // Whatever becomes of this run, those of earlier ones are on the list.
  if (auto listed = list_participants(*planned); !listed) {
    return config::refusal("palp-study", listed.error());
  }
  const AnswerTable table = table_of(planned->study);
  const Runner runner{*planned, table, *observer, say, flags.each, kind_of(flags, planned->study)};
  std::vector<Result<std::optional<std::size_t>>> ends(who->size());
  for_each_index(who->size(), [&](std::size_t i) { ends[i] = run_participant(runner, (*who)[i]); });
  const auto listed = list_participants(*planned);
  std::size_t answered = 0;
  std::size_t through = 0;
  for (const auto& end : ends) {
    if (!end) return config::refusal("palp-study", end.error());
    answered += end->value_or(std::size_t{0});
    if (end->has_value()) ++through;
  }
  if (!listed) return config::refusal("palp-study", listed.error());
  return {ExitCode::Done,
          std::to_string(through) + " participants through, " + std::to_string(answered) +
              " trials answered now\n"};
}

}  // namespace palp::study
