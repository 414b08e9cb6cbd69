#include "study/data_set.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include <openssl/evp.h>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "study/schedule.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::Json;

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

std::vector<std::string> DataSet::participants() const {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator{folder, ignored}) {
    const std::string name = entry.path().filename();
    if (name.starts_with("sub-") && entry.is_directory(ignored)) out.push_back(name);
  }
  std::ranges::sort(out);
  return out;
}

Result<void> DataSet::list_participants(const std::string& kind) const {
  std::string text = "participant_id\tkind\n";
  for (const std::string& id : participants()) text += id + '\t' + kind + '\n';
  return config::write_whole_file(folder + "/participants.tsv", text);
}

Result<PlannedStudy> open_study(const std::string& folder) {
  PlannedStudy out{.data = {folder}};
  auto text = read_whole_file(out.data.code("study.textproto"));
  if (!text) {
    return fail_to_reach(folder + " holds no planned study: palp-study plan makes one");
  }
  auto study = parse_study(*text, out.data.code("study.textproto"));
  if (!study) return tl::unexpected(study.error());
  out.study = std::move(*study);
  out.study_text = std::move(*text);
  const auto plan = read_whole_file(out.data.code("plan.json"));
  const auto schedule = read_whole_file(out.data.code("schedule.json"), kTableMax);
  const Json registered = plan ? Json::parse(*plan) : Json{};
  const auto same = [&](const char* name, const std::string& of) {
    return registered.at_or_null(name).text() == std::string_view{fingerprint(of)};
  };
  if (!schedule || !same("schedule_sha256", *schedule)) {
    out.why_not = "the schedule is not the registered one";
  } else if (!same("study_sha256", out.study_text)) {
    out.why_not = "the study file is not the registered one";
  } else if (*schedule != schedule_text(out.study)) {
    out.why_not = "this version draws another schedule than the registered one";
  }
  out.registered = out.why_not.empty();
  return out;
}

Result<std::vector<ParticipantRows>> read_rows(const PlannedStudy& planned) {
  std::vector<ParticipantRows> out;
  for (const std::string& id : planned.data.participants()) {
    ParticipantRows one{id, {}};
    for (std::size_t block = 1; block <= planned.study.conditions.size(); ++block) {
      const std::string path = planned.data.trials(id, task_name(planned.study), block);
      std::error_code ignored;
      if (!fs::exists(path, ignored)) continue;
      const auto text = read_whole_file(path, kTableMax);
      if (!text) return tl::unexpected(text.error());
      auto parsed = parse_rows(*text, path, planned.study.task);
      if (!parsed) return tl::unexpected(parsed.error());
      for (TrialRow& row : parsed->rows) one.rows.push_back(std::move(row));
    }
    out.push_back(std::move(one));
  }
  return out;
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
