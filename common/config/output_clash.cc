#include "common/config/output_clash.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "common/config/number.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"

namespace palp::config {
namespace {

namespace fs = std::filesystem;

/// What programs add to the names that they are given, besides nothing: prefixes of session files
/// and records, rows of a run under way, folders of keys.
constexpr std::array<std::string_view, 13> kAdded{"",
                                                  "surgeon.mcap",
                                                  "patient.mcap",
                                                  "-up.csv",
                                                  "-down.csv",
                                                  ".pcapng",
                                                  ".partial",
                                                  "/certificate.pem",
                                                  "/key.pem",
                                                  "/authority.pem",
                                                  "/peers.txt",
                                                  "/revoked.pem",
                                                  "/pre_shared_key.txt"};

constexpr std::string_view kSettingsEnd = ".textproto";

fs::path whole_path(const std::string& name) {
  std::error_code unresolved;
  const fs::path path = fs::weakly_canonical(fs::absolute(name, unresolved), unresolved);
  return unresolved ? fs::path{name}.lexically_normal() : path;
}

/// "PREFIX-003.mcap" of "--session-files PREFIX-": one of the files that a site numbers itself.
bool numbered_file(const std::string& prefix, const std::string& output) {
  constexpr std::string_view kEnd = ".mcap";
  const std::string name = fs::path{output}.filename().string();
  const std::string begin = fs::path{prefix}.filename().string();
  if (!name.starts_with(begin) || !name.ends_with(kEnd)) return false;
  const std::string number = name.substr(begin.size(), name.size() - begin.size() - kEnd.size());
  return !number.empty() && number.find_first_not_of("0123456789") == std::string::npos &&
         same_file((fs::path{prefix}.parent_path() / name).string(), output);
}

/// A number that is no file's name.
bool only_number(const std::string& text) {
  std::error_code ignored;
  return parse_number(text).has_value() && !fs::exists(text, ignored);
}

/// "--phantom=file:x.csv": also what stands behind '=' and behind ':'.
bool names_file(const std::string& word, const std::string& output) {
  for (std::string rest = word; !rest.empty();) {
    if (!only_number(rest)) {
      if (numbered_file(rest, output)) return true;
      for (const std::string_view added : kAdded) {
        if (same_file(rest + std::string{added}, output)) return true;
      }
    }
    const std::size_t next = rest.find_first_of("=:");
    rest = next == std::string::npos ? std::string{} : rest.substr(next + 1);
  }
  return false;
}

/// Whether a name in quotes in that text leads to the report.
bool quotes_file(const std::string& text, const std::string& output) {
  for (std::size_t from = 0; (from = text.find('"', from)) != std::string::npos;) {
    const std::size_t end = text.find('"', from + 1);
    if (end == std::string::npos) return false;
    if (names_file(text.substr(from + 1, end - from - 1), output)) return true;
    from = end + 1;
  }
  return false;
}

/// A scenario, or another text of settings, that names further files.
bool leads_to_file(const std::string& word, const std::string& output) {
  if (!word.ends_with(kSettingsEnd)) return false;
  const std::string name = word.substr(word.find('=') + 1);
  const Result<std::string> text = read_whole_file(name);
  return text && quotes_file(*text, output);
}

/// What a person calls the word: its flag.
std::string spoken_flag(const std::vector<std::string>& words, std::size_t at) {
  if (words[at].starts_with("--")) return words[at].substr(0, words[at].find('='));
  return words[at - 1].starts_with("--") ? words[at - 1] : "an argument";
}

std::string sentence(const Output& output, const std::string& other) {
  return output.flag + " and " + other + " name one file, " + printable(output.file) +
         ": what is written would take its place";
}

/// Session files are MCAP, whose first bytes say so; never read from a pipe, which might wait.
bool is_recording(const std::string& name) {
  constexpr std::string_view kMagic{"\x89MCAP0\r\n"};
  std::error_code absent;
  if (!fs::is_regular_file(name, absent)) return false;
  std::array<char, kMagic.size()> begin{};
  std::ifstream{name, std::ios::binary}.read(begin.data(), begin.size());
  return std::string_view{begin.data(), begin.size()} == kMagic;
}

}  // namespace

bool same_file(const std::string& one, const std::string& other) {
  std::error_code absent;
  const bool here = fs::exists(one, absent);
  if (here != fs::exists(other, absent)) return false;
  if (here) return fs::is_regular_file(one, absent) && fs::equivalent(one, other, absent);
  return whole_path(one) == whole_path(other);
}

std::optional<std::string> output_clash(const Output& output,
                                        const std::vector<std::string>& words,
                                        const std::string& verb,
                                        const std::string& settings) {
  bool verb_seen = verb.empty();
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!verb_seen && words[i] == verb) {
      verb_seen = true;
      continue;
    }
    const std::string flag = spoken_flag(words, i);
    if (flag == output.flag) continue;
    if (names_file(words[i], output.file)) return sentence(output, flag);
    if (leads_to_file(words[i], output.file)) return sentence(output, "a line of " + words[i]);
  }
  if (quotes_file(settings, output.file)) return sentence(output, "a setting");
  if (!is_recording(output.file)) return std::nullopt;
  return output.flag + " names " + printable(output.file) +
         ", a session file: it would be written over";
}

}  // namespace palp::config
