#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace palp::house {

/// What a pair of braces holds. Function: the outermost braces of one, not the lambdas in it.
struct Scope {
  enum class Kind { Namespace, Class, Function, Other };
  Kind kind{};
  std::size_t first_line{};  ///< from 0, where the declaration begins
  std::size_t members{};     ///< Class: data that each object has
  std::string head;          ///< what stands before the brace
};

/// Follows braces through a file, line by line, without knowing the language any better than needed
/// for code that our formatter has seen.
class Scopes {
 public:
  [[nodiscard]] bool in_class() const {
    return !open_.empty() && open_.back().kind == Scope::Kind::Class;
  }
  /// The next line, without comments and insides of literals. @returns what it closes.
  std::vector<Scope> read(std::string_view code);

 private:
  void open();
  [[nodiscard]] Scope close();
  void end_statement();
  [[nodiscard]] bool goes_on(char next) const;

  std::vector<Scope> open_;
  std::string head_;         ///< of the statement that is being read
  std::size_t head_line_{};  ///< where it began
  bool after_brace_{};       ///< head_ ends with braces: an initializer's, or its end
  std::size_t line_{};
};

}  // namespace palp::house
