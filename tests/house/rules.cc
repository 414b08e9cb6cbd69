#include "tests/house/rules.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <string>

#include "tests/house/arrows.h"

namespace palp::house {
namespace {

constexpr std::size_t kLinesMax = 400;
constexpr std::size_t kTestLinesMax = 450;  // many small cases of one idea
constexpr std::size_t kColumnsMax = 100;
constexpr std::size_t kBytesMax = 1'000'000;

bool identifier_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Whether `code` has `pattern` as a word of its own. '*' in front: as the end of a word, '(' at
/// the end: as a call.
bool has_word(std::string_view code, std::string_view pattern) {
  const bool any_beginning = pattern.starts_with('*');
  const bool call = pattern.ends_with('(');
  std::string_view word = pattern;
  if (any_beginning) word.remove_prefix(1);
  if (call) word.remove_suffix(1);
  for (auto at = code.find(word); at != code.npos; at = code.find(word, at + 1)) {
    const bool begins = any_beginning || at == 0 || !identifier_character(code[at - 1]);
    const std::string_view rest = code.substr(at + word.size());
    const auto next = rest.find_first_not_of(' ');
    const bool ends = rest.empty() || !identifier_character(rest[0]);
    if (begins && ends && (!call || (next != rest.npos && rest[next] == '('))) return true;
  }
  return false;
}

using Words = std::vector<std::string_view>;

/// Lines of code with one of `words`, in files that match none of `allowed`.
Violations forbidden_words(const Source& source,
                           const Words& words,
                           std::string_view why,
                           const Words& allowed) {
  Violations found;
  if (std::ranges::any_of(allowed, [&](auto one) { return matches(source.path, one); }))
    return found;
  for (std::size_t i = 0; i < source.code.size(); ++i) {
    for (const std::string_view word : words) {
      if (!has_word(source.code[i], word)) continue;
      found.push_back({source.path, i + 1, "'" + std::string{word} + "': " + std::string{why}});
    }
  }
  return found;
}

bool is_script(const Source& source) {
  return !source.lines.empty() && source.lines.front().starts_with("#!");
}

/// Written by people in lines: code, schemas, build files and scripts. Not prose, not tables.
bool is_written_in_lines(const Source& source) {
  return source.is_code() || source.ends_with(".proto") || source.ends_with("CMakeLists.txt") ||
         is_script(source);
}

std::size_t columns(std::string_view line) {  // UTF-8: continuation bytes take no column
  return static_cast<std::size_t>(std::ranges::count_if(
      line, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

bool comment_has_unit(const std::string& comment) {
  const auto open = comment.find('[');
  const auto close = comment.find(']', open == std::string::npos ? 0 : open);
  return open != std::string::npos && close != std::string::npos && close > open + 1;
}

bool only_comment(const Source& source, std::size_t i) {
  return source.code[i].find_first_not_of(' ') == std::string::npos &&
         source.comments[i].find_first_not_of(' ') != std::string::npos;
}

/// At a border the unit ends the name.
bool name_ends_in_unit(const std::string& code) {
  static const std::regex kName{R"(.*_(?:m|mm|s|ms|us|ns|n|hz|n_per_m|mm_per_s)(?:\{|;| =).*)"};
  return std::regex_match(code, kName);
}

/// Beside the member, or in the comment lines right above it.
bool has_unit(const Source& source, std::size_t line) {
  if (comment_has_unit(source.comments[line])) return true;
  for (std::size_t i = line; i > 0 && only_comment(source, i - 1); --i) {
    if (comment_has_unit(source.comments[i - 1])) return true;
  }
  return false;
}

/// Follows braces and knows whether it stands right inside a struct or class.
class Scopes {
 public:
  [[nodiscard]] bool in_class() const { return !kinds_.empty() && kinds_.back() == Kind::Class; }
  void read(std::string_view line) {
    if (line.starts_with('#')) return;
    for (const char c : line) {
      if (c == '{') {
        kinds_.push_back(opens_class() ? Kind::Class : Kind::Other);
        head_.clear();
      } else if (c == '}') {
        if (!kinds_.empty()) kinds_.pop_back();
        head_.clear();
      } else if (c == ';') {
        head_.clear();
      } else {
        head_ += c;
      }
    }
    head_ += ' ';
  }

 private:
  enum class Kind { Class, Other };
  [[nodiscard]] bool opens_class() const {
    static const std::regex kParameters{R"(template\s*<[^()]*?>\s*(?=struct|class|union))"};
    if (head_.find('(') != std::string::npos || has_word(head_, "enum")) return false;
    const std::string head = std::regex_replace(head_, kParameters, "");
    return has_word(head, "struct") || has_word(head, "class") || has_word(head, "union");
  }
  std::vector<Kind> kinds_;
  std::string head_;
};

}  // namespace

Violations clocks_and_sleeps(const Source& source) {
  return forbidden_words(source,
                         {"*_clock::now",
                          "clock_gettime",
                          "gettimeofday",
                          "clock_nanosleep",
                          "nanosleep",
                          "usleep",
                          "sleep(",
                          "sleep_for",
                          "sleep_until"},
                         "only common/io asks a clock or sleeps; take `now` as an argument",
                         {"common/io/*/*",
                          "netem/relay/relay.cc",
                          "common/io/net/datagram_socket.cc",  // the relay's
                          "tests/common/io/*",
                          "tests/common/io/*/*",
                          "tests/system/*",
                          "tests/system/machine/*",
                          "tests/bench/*",
                          "tests/support/realtime_*"});
}

Violations randomness(const Source& source) {
  return forbidden_words(source,
                         {"rand(",
                          "srand(",
                          "drand48",
                          "random_device",
                          "mt19937",
                          "mt19937_64",
                          "minstd_rand",
                          "default_random_engine",
                          "*_distribution",
                          "getrandom",
                          "random_shuffle"},
                         "the only randomness is common/core/random.h",
                         {"common/io/process/entropy.cc"});
}

Violations threads(const Source& source) {
  return forbidden_words(source,
                         {"std::thread", "std::jthread", "std::async", "pthread_create"},
                         "threads belong to common/io",
                         {"common/io/*/*", "tests/*", "tests/*/*", "tests/*/*/*", "tests/*/*/*/*"});
}

Violations shared_ownership(const Source& source) {
  return forbidden_words(source,
                         {"shared_ptr", "make_shared", "weak_ptr"},
                         "one owner: a value, or unique_ptr where ownership moves",
                         {});
}

Violations temporary_files(const Source& source) {
  if (!source.is_under("tests")) return {};
  return forbidden_words(source,
                         {"TempDir", "temp_directory_path"},
                         "tests run at once; take test::own_path()",
                         {"tests/support/own_path.h"});
}

Violations using_namespace(const Source& source) {
  Violations found = forbidden_words(source, {"using namespace"}, "name what you use", {});
  std::erase_if(found, [&](const Violation& violation) {  // literals have no other way in
    return source.code[violation.line - 1].find("literals") != std::string::npos;
  });
  return found;
}

Violations conditional_code(const Source& source) {
  if (source.path == "common/core/denormals.cc") return {};  // a register of each processor
  static const std::regex kDirective{R"(^\s*#\s*(if|ifdef|ifndef|elif|else)\b.*)"};
  Violations found;
  for (std::size_t i = 0; i < source.code.size(); ++i) {
    if (source.code[i].find('#') == std::string::npos) continue;
    if (!std::regex_match(source.code[i], kDirective)) continue;
    found.push_back({source.path, i + 1, "no #if: build another part instead"});
  }
  return found;
}

Violations throw_on_rt(const Source& source) {
  const bool rt = std::ranges::any_of(source.comments, [](const std::string& comment) {
    return comment.find("Thread: rt") != std::string::npos;
  });
  if (!rt) return {};
  return forbidden_words(source, {"throw"}, "this file is marked Thread: rt", {"tests/*/*"});
}

Violations members_without_unit(const Source& source) {
  static const std::regex kMember{
      R"(^\s*(?:static |mutable |const |constexpr |inline )*)"
      R"((?:double|float|std::(?:array|vector|optional|span)<(?:const )?(?:double|float)\b[^;]*>))"
      R"(\s+\w+\s*(?:[{=;].*|$))"};
  Violations found;
  if (!source.is_header() || source.is_under("tests")) return found;
  Scopes scopes;
  for (std::size_t i = 0; i < source.code.size(); ++i) {
    const std::string& code = source.code[i];
    const bool floating =
        code.find("double") != std::string::npos || code.find("float") != std::string::npos;
    if (scopes.in_class() && floating && std::regex_match(code, kMember) &&
        !name_ends_in_unit(code) && !has_unit(source, i)) {
      found.push_back({source.path, i + 1, "member without its [unit]; [-] if it has none"});
    }
    scopes.read(code);
  }
  return found;
}

Violations missing_pragma_once(const Source& source) {
  if (!source.is_header()) return {};
  const bool there = std::ranges::any_of(
      source.code, [](const std::string& code) { return code.starts_with("#pragma once"); });
  if (there) return {};
  return {{source.path, 1, "header without #pragma once"}};
}

Violations long_files(const Source& source) {
  // A schema is one list, however many knobs there are.
  const std::size_t most = source.is_under("tests") ? kTestLinesMax : kLinesMax;
  if (!is_written_in_lines(source) || source.ends_with(".proto")) return {};
  if (source.lines.size() <= most) return {};
  return {{source.path,
           source.lines.size(),
           std::to_string(source.lines.size()) + " lines; more than " + std::to_string(most) +
               " are two ideas"}};
}

Violations long_lines(const Source& source) {
  Violations found;
  if (!is_written_in_lines(source)) return found;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    if (columns(source.lines[i]) <= kColumnsMax) continue;
    found.push_back({source.path, i + 1, "line longer than 100 columns"});
  }
  return found;
}

Violations heavy_files(const Source& source) {
  if (source.size <= kBytesMax) return {};
  return {{source.path, 0, std::to_string(source.size) + " bytes; more than 1 MB is not source"}};
}

Violations unwanted_words(const Source& source) {
  // Written apart, so that this file passes its own rule.
  static const std::vector<std::string> kWords{
      "TO"
      "DO",
      "FIX"
      "ME",
      "/wo"
      "rk/",
      "/ho"
      "me/",
      "/ro"
      "ot/"};
  Violations found;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    for (const std::string& word : kWords) {
      if (source.lines[i].find(word) == std::string::npos) continue;
      found.push_back({source.path, i + 1, "'" + word + "' has no place in the tree"});
    }
  }
  return found;
}

}  // namespace palp::house
