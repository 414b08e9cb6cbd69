#include "tests/house/tree_rules.h"

#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>

#include "tests/house/arrows.h"

namespace palp::house {
namespace {

/// What only the programs of a session are made of; tests/system runs those.
constexpr std::string_view kTestedAsPrograms = "site_program";

using Files = std::map<std::string, const Source*, std::less<>>;

Files by_path(const Tree& tree) {
  Files files;
  for (const Source& source : tree) files.emplace(source.path, &source);
  return files;
}

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

/// "common/link" and the like; a part of a site counts with its site.
std::string tests_of(std::string_view room) {
  const auto slash = room.find('/');
  const bool common = room.starts_with("common/");
  return "tests/" + std::string{common ? room : room.substr(0, slash)};
}

/// All that a file includes, what those include, and what the sources beside them include.
void reach(const Files& files, const Source& from, std::set<std::string>& reached) {
  for (const Include& include : includes(from)) {
    if (!include.quoted || !reached.insert(include.target).second) continue;
    const std::string stem = include.target.substr(0, include.target.rfind('.'));
    for (const std::string_view end : {".h", ".cc"}) {
      const auto next = files.find(stem + std::string{end});
      if (next != files.end()) reach(files, *next->second, reached);
    }
  }
}

bool names(const Source& list, const std::string& file) {
  static const std::regex kWord{"[^\\s()\"]+"};
  for (const std::string& line : list.lines) {
    if (line.find(file) == std::string::npos) continue;
    for (std::sregex_iterator word{line.begin(), line.end(), kWord}, end; word != end; ++word) {
      if (word->str() == file) return true;
    }
  }
  return false;
}

/// What a line at the margin of an unnamed namespace defines: a function with its parameters, a
/// constant, a type. Empty: none.
std::string defined_name(const std::string& code) {
  static const std::regex kConstant{R"(^(?:constexpr|const) [^=({]*?\b(k[A-Z]\w*)[^\w].*)"};
  static const std::regex kType{R"(^(?:struct|class|union|enum class|enum) (\w+).*)"};
  static const std::regex kFunction{R"(^(?:[\w:<>,*&\[\]]+ )+[*&]?(\w+\([^)]*\)?).*)"};
  std::smatch found;
  for (const std::regex& form : {kConstant, kType, kFunction}) {
    if (std::regex_match(code, found, form)) return found[1];
  }
  return {};
}

}  // namespace

Violations untested_headers(const Tree& tree) {
  const Files files = by_path(tree);
  std::set<std::string> direct;
  std::map<std::string, std::set<std::string>> of_room;  // by folder of tests
  for (const Source& source : tree) {
    if (!source.is_under("tests") || !source.is_code()) continue;
    for (const Include& include : includes(source)) direct.insert(include.target);
    std::string folder = folder_of(source.path);
    for (; !folder.empty(); folder = folder_of(folder)) reach(files, source, of_room[folder]);
  }
  Violations found;
  for (const Source& source : tree) {
    if (!source.is_header() || source.is_under("tests")) continue;
    const std::string room{room_of(source.path)};
    if (room == kTestedAsPrograms) continue;
    const std::string tests = tests_of(room);
    if (room.empty() || !files.contains(tests.substr(6) + "/CMakeLists.txt")) continue;
    if (direct.contains(source.path) || of_room[tests].contains(source.path)) continue;
    found.push_back({source.path, 0, "no test of " + tests + " reads this header"});
  }
  return found;
}

Violations unlisted_sources(const Tree& tree) {
  const Files files = by_path(tree);
  Violations found;
  for (const Source& source : tree) {
    if (!source.ends_with(".cc")) continue;
    std::string folder = folder_of(source.path);
    bool has_list = false;
    bool listed = false;
    for (; !folder.empty() && !listed; folder = folder_of(folder)) {
      const auto list = files.find(folder + "/CMakeLists.txt");
      if (list == files.end() || folder == "tests") continue;
      has_list = true;
      listed = names(*list->second, source.path.substr(folder.size() + 1));
    }
    if (has_list && !listed) {
      found.push_back({source.path, 0, "in no CMakeLists.txt: nobody builds this file"});
    }
  }
  return found;
}

Violations repeated_names(const Tree& tree) {
  static const std::regex kNamespace{R"(^namespace ([\w:]+) \{.*)"};
  std::map<std::string, std::string> first;  // who gave a name
  Violations found;
  for (const Source& source : tree) {
    if (!source.ends_with(".cc") || source.is_under("tests")) continue;
    std::string room;
    bool unnamed = false;
    for (std::size_t i = 0; i < source.code.size(); ++i) {
      const std::string& code = source.code[i];
      std::smatch named;
      if (std::regex_match(code, named, kNamespace)) room = named[1];
      if (code.starts_with("namespace {")) unnamed = true;
      if (code.starts_with("}") && source.comments[i].find("// namespace") != std::string::npos) {
        unnamed = false;
      }
      const std::string name = unnamed && !code.starts_with(' ') ? defined_name(code) : "";
      if (name.empty()) continue;
      const auto [who, is_new] =
          first.try_emplace(folder_of(source.path) + ' ' + room + ' ' + name, source.path);
      if (is_new || who->second == source.path) continue;
      found.push_back({source.path, i + 1, name + " is also in " + who->second});
    }
  }
  return found;
}

Violations missing_pages(const Tree& tree) {
  static const std::regex kPage{R"(\b[a-z][a-z_0-9-]*\.md\b)"};
  std::set<std::string> pages;
  for (const Source& source : tree) {
    if (source.ends_with(".md")) pages.insert(source.path.substr(source.path.rfind('/') + 1));
  }
  Violations found;
  for (const Source& source : tree) {
    for (std::size_t i = 0; i < source.lines.size(); ++i) {
      const std::string& line = source.lines[i];
      if (line.find(".md") == std::string::npos) continue;
      for (std::sregex_iterator page{line.begin(), line.end(), kPage}, end; page != end; ++page) {
        if (pages.contains(page->str())) continue;
        found.push_back({source.path, i + 1, "cites " + page->str() + ", which is not here"});
      }
    }
  }
  return found;
}

}  // namespace palp::house
