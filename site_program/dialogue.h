#pragma once

#include <initializer_list>
#include <iosfwd>
#include <optional>
#include <string>

namespace palp::site_program {

/// How a check ends that got no answer.
inline constexpr const char* kNobodyAnswered = "nobody answered: the check was left";

/// Questions to a person, and the answers, a line each. An answer that is none is asked for again,
/// three times in all. The end of the input answers nothing. Thread: main. Blocks.
class Dialogue {
 public:
  /// Both outlive it.
  Dialogue(std::istream& in, std::ostream& out) noexcept : in_{in}, out_{out} {}

  void say(const std::string& text);
  /// Until Enter is pressed. false: nobody is there.
  [[nodiscard]] bool wait_for_enter(const std::string& text);
  /// Only "yes" is yes.
  [[nodiscard]] bool confirm(const std::string& question);
  /// In the unit that the question names.
  [[nodiscard]] std::optional<double> number(const std::string& question, double min, double max);
  [[nodiscard]] std::optional<std::string> one_of(const std::string& question,
                                                  std::initializer_list<const char*> answers);

 private:
  [[nodiscard]] std::optional<std::string> answer_to(const std::string& question);

  std::istream& in_;
  std::ostream& out_;
};

/// As printf has it; 200 characters at most.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string words(const char* format, ...);

}  // namespace palp::site_program
