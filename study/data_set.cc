#include "study/data_set.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include <openssl/evp.h>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "study/letters.h"
#include "study/preregistration.h"
#include "study/schedule.h"
#include "study/tab_cells.h"
#include "study/withdrawn.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::Json;

tl::unexpected<Error> is_link(const std::string& path) {
  return fail_to_reach(printable(path) + " is a link: a study's answers lie in its own folder");
}

/// What leads nowhere in the tree of files, like a pipe behind /dev/stdout, stays as it is named.
fs::path resolved(const std::string& name) {
  std::error_code fault;
  const fs::path whole = fs::absolute(name, fault);
  const fs::path out = fs::weakly_canonical(whole, fault);
  return fault ? whole.lexically_normal() : out;
}

bool is_participant(const Study& study, const std::string& id) {
  for (std::size_t i = 0; i < study.participants; ++i) {
    if (participant_id(i) == id) return true;
  }
  return false;
}

/// The study's participants whose folders are there, without those who withdrew, whatever is left
/// of them.
Result<std::vector<std::string>> answering(const PlannedStudy& planned) {
  auto out = planned.data.participants();
  if (!out) return out;
  const auto gone = withdrawn_participants(planned.data);
  if (!gone) return tl::unexpected(gone.error());
  std::erase_if(*out, [&](const std::string& id) {
    return !is_participant(planned.study, id) || std::ranges::find(*gone, id) != gone->end();
  });
  return out;
}

Result<std::vector<TrialRow>> rows_of(const PlannedStudy& planned, const std::string& id) {
  std::vector<TrialRow> out;
  for (std::size_t block = 1; block <= planned.study.conditions.size(); ++block) {
    const std::string path = planned.data.trials(id, task_name(planned.study), block);
    const auto text = read_if_there(path);
    if (!text) return tl::unexpected(text.error());
    if (!*text) continue;
    auto parsed = parse_rows(**text, path, row_rules(planned.study, block));
    if (!parsed) return tl::unexpected(parsed.error());
    for (TrialRow& row : parsed->rows) out.push_back(std::move(row));
  }
  return out;
}

/// Empty: it is as it was registered. `study` as its file has it.
std::string why_not_registered(const DataSet& data,
                               const Study& study,
                               const std::string& study_text,
                               const std::string& key) {
  const auto plan = read_whole_file(data.code("plan.json"));
  const auto schedule = read_whole_file(data.code("schedule.json"), kTableMax);
  const auto registration = read_whole_file(data.code("PREREGISTRATION.md"));
  const Json registered = plan ? Json::parse(*plan) : Json{};
  const auto text_of = [&](const char* name) {
    return std::string{registered.at_or_null(name).text().value_or("")};
  };
  const Fingerprints now{.study = fingerprint(study_text),
                         .schedule = schedule ? fingerprint(*schedule) : "",
                         .key = fingerprint(key)};
  if (!schedule || text_of("schedule_sha256") != now.schedule) {
    return "the schedule is not the registered one";
  }
  if (text_of("study_sha256") != now.study) return "the study file is not the registered one";
  if (text_of("key_sha256") != now.key) return "the key of the letters is not the registered one";
  if (*schedule != schedule_text(study)) {
    return "this version draws another schedule than the registered one";
  }
  if (!registration || *registration != preregistration(study, now, text_of("made_by"))) {
    return "PREREGISTRATION.md is not what this version says of the study file";
  }
  return {};
}

/// participants.tsv with its further columns, `kinds` of those who are there.
std::string participants_text(std::string_view before,
                              const std::vector<std::pair<std::string, std::string>>& kinds) {
  std::vector<std::vector<std::string_view>> lines;
  for (std::size_t end = 0; !before.empty();
       before.remove_prefix(std::min(end + 1, before.size()))) {
    end = std::min(before.find('\n'), before.size());
    lines.push_back(tab_cells(before.substr(0, end)));
  }
  std::vector<std::string_view> names{"participant_id", "kind"};
  if (!lines.empty() && lines[0].size() > 2 && lines[0][0] == names[0] && lines[0][1] == names[1]) {
    names = lines[0];
  }
  std::string text;
  const auto add = [&text](const std::vector<std::string_view>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += (i > 0 ? "\t" : "") + std::string{cells[i]};
    }
    text += '\n';
  };
  add(names);
  for (const auto& [id, kind] : kinds) {
    std::vector<std::string_view> cells(names.size(), "n/a");
    for (const auto& line : lines) {
      if (line[0] == id && line.size() == names.size()) cells = line;
    }
    cells[0] = id;
    cells[1] = kind;
    add(cells);
  }
  return text;
}

}  // namespace

std::string participant_id(std::size_t participant) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "sub-%02zu", participant + 1);
  return text.data();
}

std::string DataSet::code(const std::string& name) const { return folder + "/code/" + name; }

std::string DataSet::derived(const std::string& name) const {
  return folder + "/derivatives/palp-study/" + name;
}

std::string DataSet::trials_folder(const std::string& id) const {
  return folder + '/' + id + "/ses-01/beh";
}

std::string DataSet::traces_folder(const std::string& id) const {
  return folder + "/sourcedata/" + id;
}

std::string DataSet::trials(const std::string& id, std::string_view task, std::size_t block) const {
  std::array<char, 32> run{};
  std::snprintf(run.data(), run.size(), "_run-%02zu_beh.tsv", block);
  return trials_folder(id) + '/' + id + "_ses-01_task-" + std::string{task} + run.data();
}

Result<std::vector<std::string>> DataSet::participants() const {
  std::vector<std::string> out;
  std::error_code fault;
  const auto cannot = [&] {
    return fail_to_reach("cannot read the folder " + printable(folder) + ": " + fault.message());
  };
  fs::directory_iterator entry{folder, fault};
  if (fault) return cannot();
  while (entry != fs::directory_iterator{}) {
    const std::string name = entry->path().filename();
    if (name.starts_with("sub-")) {
      const fs::file_status status = entry->symlink_status(fault);
      // One that is deleted just now is not there.
      if (fault && status.type() != fs::file_type::not_found) return cannot();
      if (fs::is_symlink(status)) return is_link(entry->path());
      if (fs::is_directory(status)) out.push_back(name);
    }
    entry.increment(fault);
    if (fault) return cannot();
  }
  std::ranges::sort(out);
  return out;
}

Result<void> DataSet::make_trials_folder(const std::string& id) const {
  for (const std::string& one : {folder + '/' + id,
                                 folder + '/' + id + "/ses-01",
                                 trials_folder(id),
                                 folder + "/sourcedata",
                                 traces_folder(id)}) {
    std::error_code ignored;
    if (fs::is_symlink(fs::symlink_status(one, ignored))) return is_link(one);
  }
  return make_folder(trials_folder(id));
}

Result<void> DataSet::may_write(const std::string& path) const {
  const fs::path own = resolved(folder);
  const fs::path target = resolved(path);
  const fs::path below = target.lexically_relative(own);
  if (below.empty() || *below.begin() == ".." || *below.begin() == "derivatives") return {};
  return fail(printable(path) + " is in the study's own folder: below it derivatives/ is free");
}

Result<void> beside_studies(const std::string& path) {
  const fs::path target = resolved(path);
  for (fs::path above = target.parent_path(); above != above.parent_path();
       above = above.parent_path()) {
    std::error_code ignored;
    if (!fs::exists(above / "code/plan.json", ignored) ||
        !fs::exists(above / "code/study.textproto", ignored)) {
      continue;
    }
    if (auto may = DataSet{above.string()}.may_write(target.string()); !may) {
      return fail(printable(path) + " is in the folder of a study: below it derivatives/ is free");
    }
  }
  return {};
}

Result<PlannedStudy> open_without_key(const std::string& folder) {
  PlannedStudy out{.data = {folder}};
  auto text = read_whole_file(out.data.code("study.textproto"));
  if (!text) {
    return fail_to_reach(folder + " holds no planned study: palp-study plan makes one");
  }
  auto study = parse_study(*text, out.data.code("study.textproto"));
  if (!study) return tl::unexpected(study.error());
  out.study = std::move(*study);
  out.study_text = std::move(*text);
  out.why_not = "the key of the letters was not looked at";
  return out;
}

Result<PlannedStudy> open_study(const std::string& folder) {
  auto opened = open_without_key(folder);
  if (!opened) return opened;
  PlannedStudy& out = *opened;
  const std::string path = out.data.code("key.json");
  const auto key = read_whole_file(path);
  if (!key) {
    return fail_to_reach(key.error().text + "; who planned the study has the key of its letters");
  }
  const auto letters = parse_key(*key, path, out.study);
  if (!letters) return tl::unexpected(letters.error());
  out.why_not = why_not_registered(out.data, out.study, out.study_text, *key);
  out.registered = out.why_not.empty();
  out.study = lettered(std::move(out.study), *letters);
  return opened;
}

Result<std::vector<ParticipantRows>> read_rows(const PlannedStudy& planned) {
  const auto ids = answering(planned);
  if (!ids) return tl::unexpected(ids.error());
  std::vector<ParticipantRows> out;
  for (const std::string& id : *ids) {
    auto rows = rows_of(planned, id);
    if (!rows) return tl::unexpected(rows.error());
    out.push_back({id, std::move(*rows)});
  }
  return out;
}

Result<std::vector<std::string>> strangers(const PlannedStudy& planned) {
  auto out = planned.data.participants();
  if (out) std::erase_if(*out, [&](const auto& id) { return is_participant(planned.study, id); });
  return out;
}

RowRules row_rules(const Study& study, std::size_t block) {
  return {.task = study.task,
          .conditions = study.conditions.size(),
          .block = block,
          .within = study.search.within};
}

Result<void> list_participants(const PlannedStudy& planned) {
  const std::string path = planned.data.folder + "/participants.tsv";
  const auto before = read_if_there(path);
  if (!before) return tl::unexpected(before.error());
  const auto ids = answering(planned);
  if (!ids) return tl::unexpected(ids.error());
  std::vector<std::pair<std::string, std::string>> kinds;
  for (const std::string& id : *ids) {
    const auto rows = rows_of(planned, id);
    kinds.emplace_back(id, rows && !rows->empty() ? rows->front().kind : "n/a");
  }
  return config::write_whole_file(path, participants_text(before->value_or(""), kinds));
}

Result<std::optional<std::string>> read_if_there(const std::string& path) {
  std::error_code fault;
  const fs::file_status status = fs::status(path, fault);
  if (status.type() == fs::file_type::not_found) return std::nullopt;
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return fail_to_reach("cannot read " + printable(path) + ": it is no regular file");
  }
  auto text = read_whole_file(path, kTableMax);
  if (!text) return tl::unexpected(text.error());
  return std::move(*text);
}

std::string fingerprint(std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    return {};
  }
  std::string out;
  for (unsigned i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    out += kDigits[digest[i] >> 4];
    out += kDigits[digest[i] & 15];
  }
  return out;
}

Result<void> make_folder(const std::string& path) {
  std::error_code fault;
  fs::create_directories(path, fault);
  if (fault) return fail_to_reach("cannot make the folder " + path + ": " + fault.message());
  return {};
}

}  // namespace palp::study
