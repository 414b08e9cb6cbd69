#include "tests/house/scopes.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace palp::house {
namespace {

/// Without template arguments, attributes and alignment, which may have any signs.
std::string bare(std::string text) {
  static const std::regex kArguments{R"(<[^<>]*>)"};
  static const std::regex kAttributes{R"(\[\[[^\]]*\]\]|alignas\([^)]*\))"};
  text = std::regex_replace(text, kAttributes, "");
  for (std::string shorter; text != shorter;) {
    shorter = text;
    text = std::regex_replace(shorter, kArguments, "");
  }
  return text;
}

Scope::Kind kind_of(const std::string& head, bool outside_functions) {
  if (!outside_functions) return Scope::Kind::Other;
  static const std::regex kNamespace{R"(\bnamespace\b|\bextern\b)"};
  static const std::regex kEnum{R"(\benum\b)"};
  static const std::regex kClass{R"(\b(struct|class|union)\b)"};
  const std::string text = bare(head);
  if (std::regex_search(text, kNamespace)) return Scope::Kind::Namespace;
  const auto open = std::ranges::count(text, '(');
  if (open > 0 && open == std::ranges::count(text, ')')) return Scope::Kind::Function;
  if (std::regex_search(text, kEnum)) return Scope::Kind::Other;
  return std::regex_search(text, kClass) ? Scope::Kind::Class : Scope::Kind::Other;
}

/// Whether a statement of a class is data of each object.
bool is_member(const std::string& statement) {
  static const std::regex kOther{R"(\b(using|friend|typedef|static|operator|template|enum)\b)"};
  static const std::regex kTypeAndName{R"(\w+[\s*&]+\w+)"};
  static const std::regex kAhead{R"(^\s*(\w+:\s*)?(struct|class|union)\s+\w+\s*$)"};
  std::string text = bare(statement);
  if (std::regex_search(text, kOther) || std::regex_search(text, kAhead)) return false;
  text = text.substr(0, text.find('='));
  return text.find('(') == std::string::npos && std::regex_search(text, kTypeAndName);
}

}  // namespace

std::vector<Scope> Scopes::read(std::string_view code) {
  std::vector<Scope> closed;
  ++line_;
  if (code.starts_with('#')) return closed;
  for (const char c : code) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (after_brace_ && !blank) {
      if (!goes_on(c)) head_.clear();
      after_brace_ = false;
    }
    if (!blank && head_.find_first_not_of(' ') == std::string::npos) head_line_ = line_ - 1;
    if (c == '{') {
      open();
    } else if (c == '}') {
      if (!open_.empty()) closed.push_back(close());
    } else if (c == ';') {
      end_statement();
    } else {
      head_ += c;
    }
  }
  head_ += ' ';
  return closed;
}

void Scopes::open() {
  const bool outside = open_.empty() || open_.back().kind == Scope::Kind::Namespace ||
                       open_.back().kind == Scope::Kind::Class;
  open_.push_back({kind_of(head_, outside), head_line_, 0, head_});
  head_.clear();
}

Scope Scopes::close() {
  Scope scope = std::move(open_.back());
  open_.pop_back();
  const bool whole = scope.kind == Scope::Kind::Class || scope.kind == Scope::Kind::Namespace;
  head_ = whole ? "" : scope.head;  // an initializer stands in the midst of its statement
  head_line_ = scope.first_line;
  after_brace_ = true;
  return scope;
}

/// Behind a brace: a member's statement ends, and a constructor's initializers go on.
bool Scopes::goes_on(char next) const { return next == ',' || next == '{' || next == ';'; }

void Scopes::end_statement() {
  if (in_class() && is_member(head_)) ++open_.back().members;
  head_.clear();
}

}  // namespace palp::house
