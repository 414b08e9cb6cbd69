#include "study/plan_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "common/config/json.h"
#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "study/compare.h"
#include "study/data_set.h"
#include "study/schedule.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;
using config::number_text;

std::string per_cent(double share) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f %%", 100 * share);
  return text.data();
}

std::string power_table(const Study& study) {
  std::string text = "| ratio of JNDs | participants needed at 80 % power |\n| --- | --- |\n";
  for (const double ratio : {1.15, study.ratio_expected, 1.5}) {
    text += "| " + number_text(ratio) + " | " +
            std::to_string(participants_needed(std::log(ratio), study.sd_expected)) + " |\n";
  }
  return text;
}

/// Says of every column what it means, as BIDS wants it.
std::string sidecar(const Study& study) {
  Json out{{"TaskName", task_name(study)}, {"Instructions", study.instructions}};
  for (const Column& column : row_columns(study.task)) {
    Json one{{"Description", column.meaning}};
    if (!column.unit.empty()) one["Units"] = Json{column.unit};
    out[column.name] = std::move(one);
  }
  return out.dump(2) + "\n";
}

std::string key(const Study& study) {
  Json out = Json::object();
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    out[condition_code(study, i)] = Json{study.conditions[i].name};
  }
  return out.dump(2) + "\n";
}

std::string readme(const Study& study) {
  return "# " + study.name + "\n\n" + study.question +
         "\n\nMade and run by palp-study. Participants have numbers only; conditions have letters, "
         "whose key is\ncode/key.json. What was registered beforehand: "
         "code/PREREGISTRATION.md. A participant may stop\nat any time without a reason, and have "
         "everything deleted: palp-study withdraw.\n";
}

Result<void> write_all(const DataSet& data,
                       const std::vector<std::pair<std::string, std::string>>& files) {
  for (const char* folder : {"/code", "/derivatives/palp-study"}) {
    if (auto made = make_folder(data.folder + folder); !made) return made;
  }
  for (const auto& [name, text] : files) {
    auto written = config::write_whole_file(data.folder + '/' + name, text);
    if (!written) return written;
  }
  std::error_code fault;
  namespace fs = std::filesystem;
  fs::permissions(data.code("key.json"), fs::perms::owner_read | fs::perms::owner_write, fault);
  if (fault) return fail_to_reach("cannot close " + data.code("key.json"));
  return data.list_participants("person");
}

}  // namespace

std::string preregistration(const Study& study,
                            const std::string& study_sha256,
                            const std::string& schedule_sha256,
                            const std::string& made_by) {
  std::string text = "# Pre-registration: " + study.name + "\n\n";
  const auto say = [&](const std::string& what, const std::string& is) {
    text += "- " + what + ": " + (is.empty() ? "missing" : is) + "\n";
  };
  say("Question", study.question);
  say("Task",
      std::string{task_name(study)} + ", " +
          (study.task.places > 0
               ? "an area of " + number_text(1e3 * study.search.side) + " mm, found within " +
                     number_text(1e3 * study.search.within) + " mm of the axis"
               : std::to_string(felt_intervals(study.task)) + " intervals"));
  std::string conditions;
  for (const Condition& one : study.conditions) {
    conditions += (conditions.empty() ? "" : "; ") + one.name;
  }
  say("Conditions, all for everybody", conditions);
  say("Measure",
      study.task.yes_no      ? "d', criterion, and the depth at d' = 1"
      : study.task.two_sided ? "PSE and ln JND"
                             : (study.depths.empty() ? "ln JND, " : "depth and ln JND, ") +
                                   per_cent((1 + chance(study.task)) / 2) + " right");
  say("Primary comparison", study.primary);
  say("Participants",
      std::to_string(study.participants) + "; expected sd of differences of ln JND " +
          number_text(study.sd_expected));
  say("Method",
      std::string{to_string(study.method.kind)} + ", " + std::to_string(study.trials) +
          " trials in " + std::to_string(study.tracks) +
          " interleaved tracks; it stops after this number");
  say("Catch trials", per_cent(study.catch_share) + " more, at the easiest level");
  say("Excluded",
      "fewer than " + per_cent(study.catch_right_min) +
          " of catch trials right; practice not done after " +
          std::to_string(study.practice.trials_max) + " trials");
  say("Order", "rows of a Williams square; stimuli balanced, 4 equal ones on end at most");
  say("Analysis",
      "posterior of each participant and condition (palp-study fit); paired t and signed ranks of "
      "ln JND, Holm over the family; equal only by two one-sided tests within " +
          number_text(study.margin));
  say("Ethics", study.ethics_body.empty() ? "" : study.ethics_body + ", " + study.ethics_number);
  say("Seed", std::to_string(study.seed));
  say("SHA-256 of the study file", study_sha256);
  say("SHA-256 of the schedule", schedule_sha256);
  say("Made by", made_by);
  return text + "\n" + power_table(study);
}

void declare_plan(config::CommandLine& line, PlanFlags& flags) {
  line.argument("STUDY", flags.file, "text file: message Study of proto/config.proto");
  line.required();
  line.text("--out", flags.folder, "FOLDER", "the study's folder, new or empty");
  line.required();
  line.footer(
      "Writes schedule, pre-registration with fingerprints, key of the conditions, and the frame "
      "of\n"
      "a BIDS data set.");
}

ExitStatus run_plan(const PlanFlags& flags, const std::string& made_by) {
  const auto text = read_whole_file(flags.file);
  if (!text) return config::refusal("palp-study", text.error());
  const auto study = parse_study(*text, flags.file);
  if (!study) return config::refusal("palp-study", study.error());
  std::error_code ignored;
  if (std::filesystem::exists(flags.folder, ignored) &&
      !std::filesystem::is_empty(flags.folder, ignored)) {
    return {ExitCode::CannotOpen, "palp-study: " + flags.folder + " is there and not empty"};
  }
  const std::string schedule = schedule_text(*study);
  const Json plan{{"schema", "palp.study_plan/1"},
                  {"study", study->name},
                  {"study_sha256", fingerprint(*text)},
                  {"schedule_sha256", fingerprint(schedule)},
                  {"made_by", made_by}};
  const Json description{{"Name", study->name},
                         {"BIDSVersion", "1.8.0"},
                         {"DatasetType", "raw"},
                         {"GeneratedBy", Json::array()}};
  Json dataset = description;
  dataset["GeneratedBy"].push_back(Json{{"Name", "palp-study"}, {"Version", made_by}});
  const std::string task{task_name(*study)};
  const auto written = write_all(
      {flags.folder},
      {{"dataset_description.json", dataset.dump(2) + "\n"},
       {"README", readme(*study)},
       {"participants.json",
        Json{{"kind", Json{{"Description", "who answered: person, pilot or simulated"}}}}.dump(2) +
            "\n"},
       {"task-" + task + "_beh.json", sidecar(*study)},
       {"code/study.textproto", *text},
       {"code/schedule.json", schedule},
       {"code/plan.json", plan.dump(2) + "\n"},
       {"code/key.json", key(*study)},
       {"code/PREREGISTRATION.md",
        preregistration(*study, fingerprint(*text), fingerprint(schedule), made_by)}});
  if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  return {ExitCode::Done,
          std::to_string(study->participants) + " participants, " +
              std::to_string(study->conditions.size()) + " conditions, " +
              std::to_string(study->trials) + " trials each; registered in " + flags.folder +
              "/code/PREREGISTRATION.md\n"};
}

}  // namespace palp::study
