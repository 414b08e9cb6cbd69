#include "study/plan_command.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/formatted.h"
#include "common/core/random.h"
#include "common/core/whole_file.h"
#include "study/data_set.h"
#include "study/journal.h"
#include "study/letters.h"
#include "study/preregistration.h"
#include "study/schedule.h"

namespace palp::study {
namespace {

using config::ExitCode;
using config::ExitStatus;
using config::Json;

/// Says of every column what it means, as BIDS wants it.
std::string sidecar(const Study& study) {
  Json out{{"TaskName", task_name(study)}, {"Instructions", study.instructions}};
  for (const Column& column : row_columns(study.task)) {
    Json one{{"Description", column.meaning}};
    if (!column.unit.empty()) one["Units"] = column.unit;
    out[column.name] = std::move(one);
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

/// From the first moment the owner alone can read it.
Result<void> write_key(const std::string& path, const std::string& text) {
  auto file = Journal::open(path, Readers::Owner);
  if (!file) return tl::unexpected(file.error());
  return file->add(text);
}

Result<void> write_all(const DataSet& data,
                       const std::string& key,
                       const std::vector<std::pair<std::string, std::string>>& files) {
  for (const char* folder : {"/code", "/derivatives/palp-study"}) {
    if (auto made = make_folder(data.folder + folder); !made) return made;
  }
  if (auto written = write_key(data.code("key.json"), key); !written) return written;
  for (const auto& [name, text] : files) {
    auto written = config::write_whole_file(data.folder + '/' + name, text);
    if (!written) return written;
  }
  return {};
}

/// The letters of a study, by chance or by the number that was asked for.
std::string drawn_key(const Study& study,
                      const std::optional<std::uint64_t>& number,
                      const std::function<std::uint64_t()>& entropy) {
  std::uint64_t drawn = 0;
  const auto bits = [&] { return number ? random_bits(*number, 0, drawn++) : entropy(); };
  const Letters letters = drawn_letters(study.conditions.size(), bits());
  std::string salt;
  for (int i = 0; i < 2; ++i) salt += formatted("%016llx", static_cast<unsigned long long>(bits()));
  return key_text(study, letters, salt);
}

}  // namespace

void declare_plan(config::CommandLine& line, PlanFlags& flags) {
  line.argument("STUDY", flags.file, "text file: message Study of proto/config.proto");
  line.required();
  line.text("--out", flags.folder, "FOLDER", "the study's folder, new or empty");
  line.required();
  line.whole("--letters",
             flags.letters,
             {.min = 0, .max = 9007199254740991},
             "draw the letters from this number instead of by chance: for simulations that are to "
             "be repeated");
  line.footer(
      "Writes schedule, pre-registration with fingerprints, key of the conditions, and the frame "
      "of\n"
      "a BIDS data set.");
}

ExitStatus run_plan(const PlanFlags& flags,
                    const std::string& made_by,
                    const std::function<std::uint64_t()>& entropy) {
  const auto text = read_whole_file(flags.file);
  if (!text) return config::refusal("palp-study", text.error());
  const auto study = parse_study(*text, flags.file);
  if (!study) return config::refusal("palp-study", study.error());
  std::error_code ignored;
  if (std::filesystem::exists(flags.folder, ignored) &&
      !std::filesystem::is_empty(flags.folder, ignored)) {
    return {ExitCode::CannotOpen, "palp-study: " + flags.folder + " is there and not empty"};
  }
  // By the first participant's, so that what is far too large is not made first.
  Study first = *study;
  first.participants = 1;
  const std::size_t size = schedule_text(first).size() * study->participants;
  const std::string schedule = size > kTableMax ? std::string{} : schedule_text(*study);
  if (std::max(size, schedule.size()) > kTableMax) {
    return {ExitCode::BadInput,
            "palp-study: the schedule takes more than " + std::to_string(kTableMax) +
                " bytes, which is what is read again: fewer participants, conditions or trials"};
  }
  const std::string key = drawn_key(*study, flags.letters, entropy);
  const Fingerprints fingerprints{
      .study = fingerprint(*text), .schedule = fingerprint(schedule), .key = fingerprint(key)};
  const Json plan{{"schema", "palp.study_plan/1"},
                  {"study", study->name},
                  {"study_sha256", fingerprints.study},
                  {"schedule_sha256", fingerprints.schedule},
                  {"key_sha256", fingerprints.key},
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
      key,
      {{"dataset_description.json", dataset.dump(2) + "\n"},
       {"README", readme(*study)},
       {".bidsignore", "*.cut\n"},
       {"participants.json",
        Json{{"kind", Json{{"Description", "who answered: person, pilot or simulated"}}}}.dump(2) +
            "\n"},
       {"task-" + task + "_beh.json", sidecar(*study)},
       {"code/study.textproto", *text},
       {"code/schedule.json", schedule},
       {"code/plan.json", plan.dump(2) + "\n"},
       {"participants.tsv", "participant_id\tkind\n"},
       {"code/PREREGISTRATION.md", preregistration(*study, fingerprints, made_by)}});
  if (!written) return {ExitCode::CannotOpen, "palp-study: " + written.error().text};
  return {ExitCode::Done,
          std::to_string(study->participants) + " participants, " +
              std::to_string(study->conditions.size()) + " conditions, " +
              std::to_string(study->trials) + " trials each; registered in " + flags.folder +
              "/code/PREREGISTRATION.md\n"};
}

}  // namespace palp::study
