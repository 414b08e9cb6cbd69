#include "site_program/dialogue.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <istream>
#include <ostream>

#include "common/config/number.h"

namespace palp::site_program {
namespace {

constexpr int kTriesMax = 3;

}  // namespace

void Dialogue::say(const std::string& text) { out_ << text << '\n' << std::flush; }

std::optional<std::string> Dialogue::answer_to(const std::string& question) {
  out_ << question << ' ' << std::flush;
  std::string line;
  if (!std::getline(in_, line)) return std::nullopt;
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos) return std::string{};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

bool Dialogue::wait_for_enter(const std::string& text) {
  return answer_to(text + " Then press Enter.").has_value();
}

bool Dialogue::confirm(const std::string& question) {
  return answer_to(question + " (yes or no)") == "yes";
}

std::optional<double> Dialogue::number(const std::string& question, double min, double max) {
  for (int i = 0; i < kTriesMax; ++i) {
    const auto text = answer_to(question);
    if (!text) return std::nullopt;
    const auto value = config::parse_number(*text);
    if (value && *value >= min && *value <= max) return *value;
    say("  That is no number from " + config::number_text(min) + " to " + config::number_text(max) +
        ".");
  }
  return std::nullopt;
}

std::optional<std::string> Dialogue::one_of(const std::string& question,
                                            std::initializer_list<const char*> answers) {
  for (int i = 0; i < kTriesMax; ++i) {
    auto text = answer_to(question);
    if (!text || std::ranges::find(answers, *text) != answers.end()) return text;
  }
  return std::nullopt;
}

std::string words(const char* format, ...) {
  std::array<char, 200> text{};
  std::va_list values;
  va_start(values, format);
  (void)std::vsnprintf(text.data(), text.size(), format, values);
  va_end(values);
  return text.data();
}

}  // namespace palp::site_program
