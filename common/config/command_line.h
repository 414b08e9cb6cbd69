#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/document.h"
#include "common/config/exit_status.h"
#include "common/config/flag_value.h"
#include "common/core/host_and_port.h"

namespace palp::config {

/// The flags of a program, or of one of its verbs. Each declaration binds a flag to a variable that
/// outlives parse(); the variable's value before it is the default. Every flag is given at most
/// once, in any order, as "--flag value" or "--flag=value". Beyond what is declared there are
/// --help and, for the program, --version. Wrong declarations are our bug and abort.
class CommandLine {
 public:
  CommandLine(const std::string& program, const std::string& description);
  CommandLine(CommandLine&&) = delete;
  ~CommandLine();

  /// A verb: flags of its own, beside those of the program. Belongs to this object. A program with
  /// verbs needs one of them unless verbs_optional() was called.
  CommandLine& verb(const std::string& name, const std::string& description);
  void verbs_optional();

  /// A text that is not empty. `placeholder` is what --help calls the value: FILE, SPEC.
  void text(const std::string& flag,
            std::string& value,
            const std::string& placeholder,
            const std::string& meaning);
  void choice(const std::string& flag,
              std::string& value,
              const std::vector<std::string>& choices,
              const std::string& meaning);
  /// Finite, and in the range.
  void number(const std::string& flag,
              double& value,
              const NumberRange& range,
              const std::string& meaning);
  void number(const std::string& flag,
              std::optional<double>& value,
              const NumberRange& range,
              const std::string& meaning);
  void whole(const std::string& flag,
             std::uint64_t& value,
             const WholeRange& range,
             const std::string& meaning);
  void whole(const std::string& flag,
             std::optional<std::uint64_t>& value,
             const WholeRange& range,
             const std::string& meaning);
  /// HOST:PORT; `port_min` 1 where the program sends to it. Asks no resolver.
  void address(const std::string& flag,
               std::optional<HostAndPort>& value,
               std::uint16_t port_min,
               const std::string& meaning);
  /// True if given.
  void toggle(const std::string& flag, bool& value, const std::string& meaning);

  /// An argument without flag, in order of declaration; `name` as in --help: FILE.
  void argument(const std::string& name, std::string& value, const std::string& meaning);
  /// All remaining ones: at least one.
  void arguments(const std::string& name,
                 std::vector<std::string>& values,
                 const std::string& meaning);

  /// --config FILE and --set PATH=VALUE (repeated) for `document`, which parse() fills and checks:
  /// flags of knob() beat --set, which beats the file, which beats what was in it before.
  void settings(Document& document);
  /// A flag for one field of the document: meaning, unit, range and default come from the schema.
  /// A boolean field gives a switch that sets it to true.
  void knob(const std::string& flag, const std::string& path);

  /// A file that the program writes, over what was there.
  void output(const std::string& flag, std::string& file, const std::string& meaning);
  /// The output --report, JSON of `schema`.
  void report(std::string& file, const std::string& schema);

  /// What --help says below the flags: lines of at most 100 columns. Not beside settings(), which
  /// says its own there.
  void footer(const std::string& text);

  /// The flag or argument declared before must be given.
  void required();

  /// Once, on the program. Nothing: go on, all variables are set. Else --help or --version (Done),
  /// BadInput or CannotOpen with one sentence; variables may then be half set.
  [[nodiscard]] std::optional<ExitStatus> parse(int argc, const char* const* argv);

  /// After parse().
  [[nodiscard]] bool given(std::string_view flag) const;
  /// What report() declared and was given, of the program or its verb; also after a failed parse().
  struct AskedReport {
    std::string file;  ///< empty: none
    std::string schema;
    std::optional<std::string> clash{};  ///< why it must not be written there
  };
  [[nodiscard]] AskedReport asked_report() const;
  /// Of the outputs that were given, the first that must not be written there: why; see
  /// output_clash.h.
  [[nodiscard]] std::optional<std::string> clash() const;
  [[nodiscard]] const std::string& program() const;
  /// The verb's name; empty: none.
  [[nodiscard]] std::string chosen_verb() const;

 private:
  struct Parts;  ///< keeps the parser's types out of this header
  explicit CommandLine(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace palp::config
