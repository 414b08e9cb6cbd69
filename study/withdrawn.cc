#include "study/withdrawn.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "study/journal.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;

std::string list_of(const DataSet& data) { return data.code("withdrawn.txt"); }

/// "sub-10" is not in "sub-100".
bool names(std::string_view text, std::string_view id) {
  for (std::size_t at = text.find(id); at != std::string_view::npos; at = text.find(id, at + 1)) {
    const std::size_t end = at + id.size();
    if (end == text.size() || std::isdigit(static_cast<unsigned char>(text[end])) == 0) return true;
  }
  return false;
}

}  // namespace

Result<std::vector<std::string>> withdrawn_participants(const DataSet& data) {
  const auto text = read_if_there(list_of(data));
  if (!text) return tl::unexpected(text.error());
  std::vector<std::string> out;
  std::string_view left = *text ? std::string_view{**text} : std::string_view{};
  while (!left.empty()) {  // a last line counts without its end too
    const std::string_view line = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(line.size() + 1, left.size()));
    const bool of_another_system = line.ends_with('\r');
    if (!line.empty()) out.emplace_back(line.substr(0, line.size() - (of_another_system ? 1 : 0)));
  }
  return out;
}

Result<bool> has_withdrawn(const DataSet& data, const std::string& id) {
  const auto list = withdrawn_participants(data);
  if (!list) return tl::unexpected(list.error());
  return std::ranges::find(*list, id) != list->end();
}

Result<void> add_withdrawn(const DataSet& data, const std::string& id) {
  auto list = Journal::open(list_of(data));
  if (!list) return tl::unexpected(list.error());
  const bool unfinished = !list->text().empty() && !list->text().ends_with('\n');
  return list->add((unfinished ? "\n" : "") + id + '\n');
}

Result<void> delete_participant(const DataSet& data, const std::string& id) {
  std::error_code fault;
  for (const std::string& path : {data.folder + '/' + id, data.traces_folder(id)}) {
    fs::remove_all(path, fault);
    if (fault) return fail_to_reach("cannot delete " + printable(path) + ": " + fault.message());
  }
  return {};
}

Result<std::vector<std::string>> withdrawn_with_data(const DataSet& data) {
  auto list = withdrawn_participants(data);
  if (!list) return list;
  std::ranges::sort(*list);
  list->erase(std::unique(list->begin(), list->end()), list->end());
  std::erase_if(*list, [&](const std::string& id) {
    std::error_code fault;
    const auto none = [&](const std::string& path) {
      return fs::symlink_status(path, fault).type() == fs::file_type::not_found;
    };
    return none(data.folder + '/' + id) && none(data.traces_folder(id));
  });
  return list;
}

Result<std::vector<std::string>> files_with(const DataSet& data, const std::string& id) {
  std::vector<std::string> out;
  std::error_code fault;
  fs::recursive_directory_iterator entry{data.folder, fault};
  while (!fault && entry != fs::recursive_directory_iterator{}) {
    const std::string path = entry->path();
    const bool regular = fs::is_regular_file(entry->symlink_status(fault));
    if (!fault && path != list_of(data)) {
      bool holds = names(entry->path().filename().string(), id);
      if (regular && !holds && entry->path().extension() != ".mcap") {
        const auto text = read_whole_file(path, kTableMax);
        if (!text) return tl::unexpected(text.error());
        holds = names(*text, id);
      }
      if (holds) out.push_back(path);
    }
    if (!fault) entry.increment(fault);
  }
  if (fault) {
    return fail_to_reach("cannot search " + printable(data.folder) + ": " + fault.message());
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace palp::study
