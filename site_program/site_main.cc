#include "site_program/site_main.h"

#include <algorithm>
#include <exception>

#include <malloc.h>

#include "common/config/program_run.h"
#include "common/config/report.h"
#include "common/io/process/hardening.h"

namespace palp::site_program {
namespace {

constexpr int kHeapSpare = 4 << 20;  // [bytes], many times what a session's heap goes up and down

}  // namespace

void declare_session_flags(config::CommandLine& line) {
  line.knob("--session-file", "record.file");
  line.knob("--session-files", "record.files");
  line.knob("--duration-s", "duration_s");
  line.knob("--delay-ms", "impairment.delay_ms");
  line.knob("--jitter-ms", "impairment.jitter_ms");
  line.knob("--loss", "impairment.loss");
  line.knob("--impair", "impairment.spec");
  line.knob("--seed", "seed");
  line.knob("--identity", "link.identity");
  line.knob("--through", "link.through");
  line.knob("--room", "link.room");
  line.knob("--insecure", "link.insecure");
  line.knob("--monitor", "monitor.serve");
  line.knob("--monitor-port", "monitor.port");
  line.knob("--monitor-origin", "monitor.origin");
}

int run(const SiteMain& program, int argc, const char* const* argv) {
  // First of all: keys are read later.
  if (const auto refused = io::harden_process()) io::warn(*refused);
  // One heap for all threads, since the one in a hurry needs none: what one thread frees another
  // takes again, so a site of many hours grows no more, and 200 MB less are locked.
  (void)::mallopt(M_ARENA_MAX, 1);
  // And it keeps what it has, with room for its ups and downs: a page that is asked for in the
  // session is locked there and then, and looks like a leak.
  (void)::mallopt(M_TOP_PAD, kHeapSpare);
  (void)::mallopt(M_TRIM_THRESHOLD, 16 * kHeapSpare);
  (void)::mallopt(M_MMAP_THRESHOLD, 8 * kHeapSpare);
  SiteReport report;
  report.site = program.site;
  if (const auto exit_status = program.line.parse(argc, argv)) {
    if (exit_status->code == config::ExitCode::Done || program.report_file.empty() ||
        program.line.asked_report().clash) {
      return config::leave(program.line, *exit_status);
    }
    report.exit_status = exit_status_of(*exit_status);
    return finish(report, program.report_file);
  }
  if (const auto closed = config::closed_output(program.line)) return config::leave(*closed);
  const auto verb = std::ranges::find(program.verbs, program.line.chosen_verb(), &SideVerb::name);
  if (verb != program.verbs.end()) {
    const ExitStatus exit_status = verb->run();
    const std::string sentence =
        exit_status.reason.empty() ? "" : program.line.program() + ": " + exit_status.reason;
    return config::leave(program.line, {exit_status.code, sentence});
  }
  try {
    report.exit_status = program.session(report);
  } catch (const std::exception& error) {
    report.exit_status = cannot_start(error.what());
  }
  return finish(report, program.report_file);
}

}  // namespace palp::site_program
