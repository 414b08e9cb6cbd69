#pragma once

#include <string>

#include "common/config/command_line.h"

/// Verbs that look after a study's folder.
namespace palp::study {

/// `palp-study export`, `check`, `withdraw`, as given on the command line.
struct KeepFlags {
  std::string folder{};
  std::string format{"quickpsy"};
  std::string out{};
  std::string participant{};
};

void declare_export(config::CommandLine& line, KeepFlags& flags);
[[nodiscard]] config::ExitStatus run_export(const KeepFlags& flags);

/// Study file and schedule are the registered ones, and every answer is to a trial that the
/// schedule and the answers before it ask for.
void declare_check(config::CommandLine& line, KeepFlags& flags);
[[nodiscard]] config::ExitStatus run_check(const KeepFlags& flags);

/// A participant's answers go, and everything that was derived from anybody's.
void declare_withdraw(config::CommandLine& line, KeepFlags& flags);
[[nodiscard]] config::ExitStatus run_withdraw(const KeepFlags& flags);

}  // namespace palp::study
