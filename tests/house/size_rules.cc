#include "tests/house/size_rules.h"

#include <algorithm>
#include <string>

#include "tests/house/scopes.h"

namespace palp::house {
namespace {

constexpr std::size_t kMembersMax = 25;
constexpr std::size_t kFunctionLinesMax = 60;

bool only_comment(const Source& source, std::size_t i) {
  return source.code[i].find_first_not_of(' ') == std::string::npos &&
         source.comments[i].find_first_not_of(' ') != std::string::npos;
}

/// A table or a list of knobs is one idea however long it is, if the comment above it says so.
bool is_one_list(const Source& source, std::size_t first_line) {
  for (std::size_t i = first_line; i > 0 && only_comment(source, i - 1); --i) {
    if (source.comments[i - 1].find("One list") != std::string::npos) return true;
  }
  return false;
}

template <class Judge>
Violations judged(const Source& source, Judge judge) {
  Violations found;
  if (!source.is_code()) return found;
  Scopes scopes;
  for (std::size_t i = 0; i < source.code.size(); ++i) {
    for (const Scope& scope : scopes.read(source.code[i])) {
      const std::string sentence = judge(scope, i);
      if (sentence.empty() || is_one_list(source, scope.first_line)) continue;
      found.push_back({source.path, scope.first_line + 1, sentence});
    }
  }
  return found;
}

}  // namespace

Violations crowded_classes(const Source& source) {
  return judged(source, [](const Scope& scope, std::size_t) -> std::string {
    if (scope.kind != Scope::Kind::Class || scope.members <= kMembersMax) return {};
    return std::to_string(scope.members) + " members; more than " + std::to_string(kMembersMax) +
           " are two ideas";
  });
}

Violations long_functions(const Source& source) {
  return judged(source, [](const Scope& scope, std::size_t last) -> std::string {
    const std::size_t lines = last - scope.first_line + 1;
    if (scope.kind != Scope::Kind::Function || lines <= kFunctionLinesMax) return {};
    return std::to_string(lines) + " lines; more than " + std::to_string(kFunctionLinesMax) +
           " are two thoughts";
  });
}

}  // namespace palp::house
