// Input: the arguments of a program, one a line. Each line is read as a number and as an address
// too.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "common/config/number.h"
#include "common/core/check.h"
#include "common/core/printable.h"
#include "tests/fuzz/fuzz.h"

namespace palp::config {
namespace {

void number_laws(std::string_view text) {
  if (const auto number = parse_number(text)) {
    PALP_CHECK(std::isfinite(*number), "a number is finite");
    PALP_CHECK(parse_number(number_text(*number)) == number, "a number reads back as itself");
  }
  if (const auto share = parse_share(text)) {
    PALP_CHECK(std::isfinite(*share), "a share is finite");
  }
  if (const auto whole = parse_whole(text)) {
    PALP_CHECK(parse_whole(std::to_string(*whole)) == whole, "a whole number reads back");
    PALP_CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }),
               "a whole number has digits only");
  }
  if (const auto integer = parse_integer(text)) {
    PALP_CHECK(parse_integer(std::to_string(*integer)) == integer, "an integer reads back");
  }
  const std::string shown = printable(text);
  PALP_CHECK(shown.size() <= 83 && printable(shown.substr(0, 80)) == shown.substr(0, 80),
             "what is printable stays as it is");
}

void endpoint_laws(std::string_view text) {
  const auto endpoint = parse_host_and_port(text);
  if (!endpoint) {
    PALP_CHECK(!endpoint.error().text.empty(), "a refusal says why");
    return;
  }
  const auto again = parse_host_and_port(endpoint->to_string());
  PALP_CHECK(again.has_value() && *again == *endpoint, "an address reads back as itself");
  PALP_CHECK(parse_host_and_port(text, 1).has_value() == (endpoint->port != 0),
             "0 is no port to call");
}

void program_laws(const std::vector<std::string>& arguments) {
  std::string text{"default"};
  std::string choice{"paper"};
  std::string file;
  double number = 1;
  std::optional<double> loss;
  std::uint64_t whole = 1;
  std::optional<HostAndPort> listen;
  bool toggle = false;
  CommandLine program{"fuzz", "takes every kind of flag"};
  program.text("--text", text, "TEXT", "a text");
  program.choice("--choice", choice, {"paper", "other"}, "a choice");
  program.number("--number", number, NumberRange{-2.5, 3, "N"}, "a number");
  program.number("--loss", loss, NumberRange{0, 1, "share"}, "a share");
  program.whole("--whole", whole, WholeRange{1, 1000}, "a whole number");
  program.address("--listen", listen, 1, "an address");
  program.toggle("--toggle", toggle, "a switch");
  CommandLine& verb = program.verb("run", "a verb");
  verb.argument("FILE", file, "a file");
  program.verbs_optional();

  std::vector<const char*> words{"fuzz"};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  const auto exit_status = program.parse(static_cast<int>(words.size()), words.data());
  if (exit_status) {
    PALP_CHECK(!exit_status->text.empty(), "an ending says why");
    PALP_CHECK(exit_status->code == ExitCode::Done || exit_status->code == ExitCode::BadInput,
               "nothing was opened");
    return;
  }
  PALP_CHECK(!text.empty() && (choice == "paper" || choice == "other"), "texts keep their rules");
  PALP_CHECK(number >= -2.5 && number <= 3 && whole >= 1 && whole <= 1000, "numbers keep ranges");
  PALP_CHECK(!loss || (*loss >= 0 && *loss <= 1), "numbers keep ranges");
  PALP_CHECK(!listen || listen->port >= 1, "addresses keep their range");
  PALP_CHECK(toggle == program.given("--toggle"), "a switch is on where it was given");
  PALP_CHECK(program.chosen_verb().empty() || program.chosen_verb() == "run", "a known verb");
}

}  // namespace
}  // namespace palp::config

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = palp::fuzz::as_text(data, size);
  std::vector<std::string> lines;
  while (!rest.empty() && lines.size() < 32) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    palp::config::number_laws(line);
    palp::config::endpoint_laws(line);
    lines.emplace_back(line);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  palp::config::program_laws(lines);
  return 0;
}
