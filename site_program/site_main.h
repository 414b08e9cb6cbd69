#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/config/command_line.h"
#include "common/core/result.h"
#include "common/io/process/diagnostics.h"
#include "common/io/process/terminal.h"
#include "site_program/exit_status.h"
#include "site_program/site_report.h"

/// What both programs do between main() and their site.
namespace palp::site_program {

/// The flags both have for their session, in the order of --help.
void declare_session_flags(config::CommandLine& line);

/// A verb of a program, which needs no session.
struct SideVerb {
  std::string_view name;
  std::function<ExitStatus()> run;
};

/// A program: its flags, declared, and what it does with them.
struct SiteMain {
  std::string site;  ///< "surgeon" or "patient"
  config::CommandLine& line;
  const std::string& report_file;
  std::vector<SideVerb> verbs;
  /// Fills in the report; may throw where the site cannot start.
  std::function<ExitStatus(SiteReport& report)> session;
};

/// Parses, runs a verb or the session, and writes the report, however that ended. @returns what
/// main() returns.
[[nodiscard]] int run(const SiteMain& program, int argc, const char* const* argv);

/// A session of a `Program`: made of its plan, run at the terminal, stopped. A plan has `settings`.
template <class Program, class Plan>
ExitStatus run_session(tl::expected<Plan, ExitStatus> plan, SiteReport& report) {
  if (!plan) return plan.error();
  report.seed = plan->settings.seed;
  report.coupling = plan->settings.coupling.name;
  const settings::RecordSettings& files = plan->settings.record;
  report.session_file = files.files.empty() ? files.file : files.files + "*.mcap";
  std::optional<io::Terminal> terminal{std::in_place};
  if (plan->settings.protection.insecure) {
    io::warn("datagrams are neither encrypted nor authenticated: they stay on this machine");
  }
  Program program{std::move(*plan)};
  report.exit_status = program.run(*terminal);
  terminal.reset();  // what ends from here on ends by itself
  program.stop(report);
  return with_recording(report.exit_status, report.records);
}

}  // namespace palp::site_program
