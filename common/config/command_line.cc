#include "common/config/command_line.h"

#include <algorithm>
#include <array>
#include <functional>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/config/number.h"
#include "common/config/output_clash.h"
#include "common/config/settings_flags.h"
#include "common/core/check.h"
#include "common/core/printable.h"

namespace palp::config {
namespace {

using Values = std::vector<std::string>;

ExitStatus bad_input(std::string text) { return {ExitCode::BadInput, std::move(text)}; }

/// The last step of reading a value.
template <class Variable>
auto store_in(Variable& variable) {
  return [&variable](const auto& value) { variable = value; };
}

/// What was declared of one flag or argument.
struct Declared {
  std::string name;
  CLI::Option* option{};
  std::function<Result<void>(const Values&)> take;  ///< called with at least one value
  bool once{true};
  bool required{};
};

struct DeclaredOutput {
  std::string flag;
  const CLI::Option* option{};
  std::string schema;  ///< of a report, else empty
};

}  // namespace

struct CommandLine::Parts {
  std::string program;
  std::unique_ptr<CLI::App> owned;  ///< of the program; verbs are owned by it
  CLI::App* app{};
  std::vector<Declared> declared;
  std::vector<std::unique_ptr<CommandLine>> verbs;
  bool verb_needed{true};
  Values words;  ///< as given to the program

  std::vector<DeclaredOutput> own_outputs;
  std::vector<DeclaredOutput>* outputs{&own_outputs};  ///< of the program, verbs' included

  SettingsFlags settings;

  void declare(const std::string& name,
               const std::string& placeholder,
               const std::string& meaning,
               bool once,
               std::function<Result<void>(const Values&)> take);
  void declare_switch(const std::string& name,
                      const std::string& meaning,
                      std::function<void()> take);
  template <class Variable, class Range>
  void declare_number(const std::string& flag,
                      Variable& value,
                      const Range& range,
                      const std::string& meaning,
                      const std::string& preset = {});
  [[nodiscard]] std::optional<ExitStatus> take_values();
  [[nodiscard]] std::optional<ExitStatus> take_all();
  [[nodiscard]] std::optional<ExitStatus> unexpected_word() const;
  /// Of the program.
  [[nodiscard]] std::optional<std::string> clash_of(const DeclaredOutput& output) const;
};

void CommandLine::Parts::declare(const std::string& name,
                                 const std::string& placeholder,
                                 const std::string& meaning,
                                 bool once,
                                 std::function<Result<void>(const Values&)> take) {
  // Values stay texts: the parser splits the line, what a text means is decided here.
  const auto keep = [](const CLI::results_t&) { return true; };
  CLI::Option* const option = app->add_option(name, keep, meaning);
  const bool positional = name.front() != '-';
  option->type_name(positional ? "" : placeholder);
  option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  if (positional && !once) {
    option->expected(-1);
  } else {
    option->expected(1)->allow_extra_args(false);
  }
  declared.push_back({.name = name, .option = option, .take = std::move(take), .once = once});
}

void CommandLine::Parts::declare_switch(const std::string& name,
                                        const std::string& meaning,
                                        std::function<void()> take) {
  const auto take_one = [name, take = std::move(take)](const Values& given) -> Result<void> {
    return read_switch(name, given.front()).map(take);
  };
  declared.push_back({.name = name, .option = app->add_flag(name, meaning), .take = take_one});
}

template <class Variable, class Range>
void CommandLine::Parts::declare_number(const std::string& flag,
                                        Variable& value,
                                        const Range& range,
                                        const std::string& meaning,
                                        const std::string& preset) {
  constexpr bool kWhole = std::is_same_v<Range, WholeRange>;
  const std::string said = describe(meaning, range) + preset;
  declare(flag, kWhole ? "N" : "X", said, true, [flag, &value, range](const Values& given) {
    if constexpr (kWhole) {
      return read_whole(flag, given.front(), range).map(store_in(value));
    } else {
      return read_number(flag, given.front(), range).map(store_in(value));
    }
  });
}

std::optional<ExitStatus> CommandLine::Parts::take_values() {
  for (const Declared& one : declared) {
    const Values& values = one.option->results();
    if (values.empty()) {
      if (one.required) return bad_input(one.name + " is missing; see --help");
      continue;
    }
    if (one.once && values.size() > 1) {
      return bad_input(one.name + " is given " + std::to_string(values.size()) +
                       " times, at most once is meant");
    }
    for (const std::string& value : values) {
      if (value.rfind("--", 0) == 0) {  // the next flag, taken for the value
        return bad_input(one.name + " needs a value, not " + printable(value));
      }
    }
    if (const auto taken = one.take(values); !taken) return bad_input(taken.error().text);
  }
  return std::nullopt;
}

std::optional<ExitStatus> CommandLine::Parts::take_all() {
  if (auto exit_status = take_values()) return exit_status;
  return settings.fill();
}

std::optional<ExitStatus> CommandLine::Parts::unexpected_word() const {
  Values names;
  for (const auto& verb : verbs) names.push_back(verb->parts_->app->get_name());
  const bool chosen = !app->get_subcommands().empty();
  const auto left = app->remaining(true);
  if (!left.empty()) {
    const std::string word = '"' + printable(left.front()) + '"';
    if (!chosen && !names.empty() && left.front().front() != '-') {
      return bad_input(word + " is no verb of " + program + ", there are: " + list_text(names));
    }
    return bad_input(word + " is not expected here; see --help");
  }
  if (!chosen && !names.empty() && verb_needed) {
    return bad_input("a verb is missing, one of: " + list_text(names));
  }
  return std::nullopt;
}

CommandLine::CommandLine(const std::string& program, const std::string& description)
    : parts_{std::make_unique<Parts>()} {
  parts_->program = program;
  parts_->owned = std::make_unique<CLI::App>(description, program);
  parts_->app = parts_->owned.get();
  parts_->app->set_help_flag("--help,-h", "print this and exit");
  parts_->app->set_version_flag(
      "--version", program + " (palp) " PALP_VERSION, "print the version and exit");
  parts_->app->allow_extras();  // to word the complaint ourselves
  parts_->app->get_formatter()->label("SUBCOMMAND", "VERB");
}

CommandLine::CommandLine(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}
CommandLine::~CommandLine() = default;

CommandLine& CommandLine::verb(const std::string& name, const std::string& description) {
  auto parts = std::make_unique<Parts>();
  parts->program = parts_->program + ' ' + name;
  parts->outputs = parts_->outputs;
  parts->app = parts_->app->add_subcommand(name, description);
  parts->app->allow_extras();
  parts->app->fallthrough();  // the program's own flags may stand behind the verb too
  parts->app->group("Verbs");
  parts_->app->require_subcommand(0, 1);
  parts_->verbs.push_back(std::unique_ptr<CommandLine>{new CommandLine{std::move(parts)}});
  return *parts_->verbs.back();
}

void CommandLine::verbs_optional() { parts_->verb_needed = false; }

void CommandLine::text(const std::string& flag,
                       std::string& value,
                       const std::string& placeholder,
                       const std::string& meaning) {
  parts_->declare(flag, placeholder, meaning, true, [flag, &value](const Values& given) {
    return read_text(flag, given.front()).map(store_in(value));
  });
}

void CommandLine::choice(const std::string& flag,
                         std::string& value,
                         const std::vector<std::string>& choices,
                         const std::string& meaning) {
  const std::string preset = value.empty() ? "" : ", default " + value;
  const std::string said = meaning + ": " + list_text(choices) + preset;
  parts_->declare(flag, "NAME", said, true, [flag, &value, choices](const Values& given) {
    return read_choice(flag, given.front(), choices).map(store_in(value));
  });
}

void CommandLine::number(const std::string& flag,
                         double& value,
                         const NumberRange& range,
                         const std::string& meaning) {
  parts_->declare_number(flag, value, range, meaning, ", default " + number_text(value));
}

void CommandLine::number(const std::string& flag,
                         std::optional<double>& value,
                         const NumberRange& range,
                         const std::string& meaning) {
  parts_->declare_number(flag, value, range, meaning);
}

void CommandLine::whole(const std::string& flag,
                        std::uint64_t& value,
                        const WholeRange& range,
                        const std::string& meaning) {
  parts_->declare_number(flag, value, range, meaning, ", default " + std::to_string(value));
}

void CommandLine::whole(const std::string& flag,
                        std::optional<std::uint64_t>& value,
                        const WholeRange& range,
                        const std::string& meaning) {
  parts_->declare_number(flag, value, range, meaning);
}

void CommandLine::address(const std::string& flag,
                          std::optional<HostAndPort>& value,
                          std::uint16_t port_min,
                          const std::string& meaning) {
  parts_->declare(flag, "HOST:PORT", meaning, true, [flag, &value, port_min](const Values& given) {
    return read_address(flag, given.front(), port_min).map(store_in(value));
  });
}

void CommandLine::toggle(const std::string& flag, bool& value, const std::string& meaning) {
  parts_->declare_switch(flag, meaning, [&value] { value = true; });
}

void CommandLine::argument(const std::string& name,
                           std::string& value,
                           const std::string& meaning) {
  text(name, value, "", meaning);
}

void CommandLine::arguments(const std::string& name,
                            std::vector<std::string>& values,
                            const std::string& meaning) {
  parts_->declare(name, "", meaning, false, [&values](const Values& given) {
    values = given;
    return Result<void>{};
  });
  required();
}

void CommandLine::settings(Document& document) {
  PALP_CHECK(parts_->settings.document == nullptr, "one document for one command line");
  parts_->settings.document = &document;
  text("--config", parts_->settings.config_file, "FILE", "settings, in protobuf's text format");
  parts_->declare(
      "--set", "PATH=VALUE", "one setting; may be repeated", false, [this](const Values& given) {
        parts_->settings.overrides = given;
        return Result<void>{};
      });
  parts_->app->footer("Settings, for --config and --set:\n" + document.describe());
}

void CommandLine::knob(const std::string& flag, const std::string& path) {
  PALP_CHECK(parts_->settings.document != nullptr, "settings() comes before knob()");
  const std::string meaning = parts_->settings.document->describe(path);
  if (parts_->settings.document->is_switch(path)) {
    parts_->declare_switch(flag, meaning, [this, flag, path] {
      parts_->settings.knobs.push_back({path, "true", flag});
    });
    return;
  }
  parts_->declare(flag, "VALUE", meaning, true, [this, flag, path](const Values& given) {
    parts_->settings.knobs.push_back({path, given.front(), flag});
    return Result<void>{};
  });
}

void CommandLine::output(const std::string& flag, std::string& file, const std::string& meaning) {
  text(flag, file, "FILE", meaning);
  parts_->outputs->push_back({flag, parts_->declared.back().option, {}});
}

void CommandLine::report(std::string& file, const std::string& schema) {
  output("--report", file, "JSON report, written also when the run fails");
  parts_->outputs->back().schema = schema;
}

void CommandLine::footer(const std::string& text) { parts_->app->footer(text); }

void CommandLine::required() {
  PALP_CHECK(!parts_->declared.empty(), "required() follows a declaration");
  parts_->declared.back().required = true;
}

std::optional<ExitStatus> CommandLine::parse(int argc, const char* const* argv) {
  PALP_CHECK(parts_->owned != nullptr, "the program parses, not its verbs");
  CLI::App& app = *parts_->app;
  parts_->words.assign(argv, argv + argc);
  const auto prefixed = [this](ExitStatus exit_status) {
    exit_status.text = parts_->program + ": " + exit_status.text;
    return exit_status;
  };
  try {
    app.parse(std::max(argc, 1), argv);  // an empty argv has no program name either
  } catch (const CLI::CallForHelp&) {
    return ExitStatus{ExitCode::Done, app.help()};
  } catch (const CLI::CallForVersion& version) {
    return ExitStatus{ExitCode::Done, std::string{version.what()} + '\n'};
  } catch (const CLI::ArgumentMismatch& mismatch) {  // "--seed: 1 required N missing"
    const std::string_view what{mismatch.what()};
    return prefixed(bad_input(printable(what.substr(0, what.find(':'))) + " needs a value"));
  } catch (const CLI::ParseError& error) {
    return prefixed(bad_input(printable(error.what())));
  }
  std::optional<ExitStatus> exit_status = parts_->unexpected_word();
  if (exit_status) {
    (void)parts_->take_values();  // who names a report gets one, also of a word too many
  } else {
    exit_status = parts_->take_all();
  }
  for (const auto& verb : parts_->verbs) {
    if (!exit_status && verb->parts_->app->parsed()) {
      exit_status = verb->parts_->take_all();
    }
  }
  return exit_status ? std::optional{prefixed(*exit_status)} : std::nullopt;
}

bool CommandLine::given(std::string_view flag) const {
  for (const Declared& one : parts_->declared) {
    if (one.name == flag) return !one.option->empty();
  }
  PALP_CHECK(false, "given() asks for a flag that was declared");
  return false;
}

std::optional<std::string> CommandLine::Parts::clash_of(const DeclaredOutput& output) const {
  if (words.empty() || output.option->empty()) return std::nullopt;
  const auto chosen = app->get_subcommands();
  return output_clash({output.flag, output.option->results().front()},
                      words,
                      chosen.empty() ? "" : chosen.front()->get_name(),
                      settings.document != nullptr ? settings.document->text() : "");
}

CommandLine::AskedReport CommandLine::asked_report() const {
  for (const DeclaredOutput& one : *parts_->outputs) {
    if (one.schema.empty() || one.option->empty()) continue;
    return {one.option->results().front(), one.schema, parts_->clash_of(one)};
  }
  return {};
}

std::optional<std::string> CommandLine::clash() const {
  for (const DeclaredOutput& one : *parts_->outputs) {
    if (auto clash = parts_->clash_of(one)) return clash;
  }
  return std::nullopt;
}

const std::string& CommandLine::program() const { return parts_->program; }

std::string CommandLine::chosen_verb() const {
  for (const auto& verb : parts_->verbs) {
    if (verb->parts_->app->parsed()) return verb->parts_->app->get_name();
  }
  return {};
}

}  // namespace palp::config
