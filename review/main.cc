// palp-review: reads session files. It is linked into no site.
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "common/config/command_line.h"
#include "common/config/exit_code.h"
#include "common/config/program_run.h"
#include "common/config/report.h"
#include "common/core/printable.h"
#include "common/record/mapped_file.h"
#include "common/record/mcap_reader.h"
#include "review/check.h"
#include "review/demo_report.h"
#include "review/info.h"
#include "review/recover.h"
#include "review/taps.h"

namespace palp::review {
namespace {

using config::ExitCode;
using config::ExitStatus;

ExitStatus bad_input(const std::string& text) {
  return {ExitCode::BadInput, "palp-review: " + text};
}
ExitStatus cannot_open(const std::string& text) {
  return {ExitCode::CannotOpen, "palp-review: " + text};
}

ExitStatus exit_status_of(const Error& error) { return config::refusal("palp-review", error); }

/// A file that may be cut off or damaged, but is a session file.
Result<record::MappedFile> open_session(const std::string& path) {
  auto file = record::MappedFile::open(path);
  if (!file) {
    return file;
  }
  const record::McapReader reader{file->bytes()};
  if (!reader.report().faults.empty()) {
    return fail(path + ": " + reader.report().faults.front().text);
  }
  return file;
}

ExitStatus run_info(const std::string& path) {
  const auto file = open_session(path);
  if (!file) {
    return exit_status_of(file.error());
  }
  std::cout << describe(file->bytes());
  return {};
}

ExitStatus run_check(const std::string& path) {
  const auto file = record::MappedFile::open(path);
  if (!file) {
    return exit_status_of(file.error());
  }
  if (const auto fault = first_fault(file->bytes())) {
    std::cout << harmless_line(path) << ": " << *fault << '\n';
    return {ExitCode::Missed, {}};
  }
  std::cout << harmless_line(path) << ": whole, closed, every message decodes\n";
  return {};
}

ExitStatus run_recover(const std::string& in, const std::string& out) {
  const auto file = open_session(in);
  if (!file) {
    return exit_status_of(file.error());
  }
  auto sink = record::FileSink::create(out);
  if (!sink) {
    return cannot_open(sink.error().text);
  }
  const auto recovery = recover(file->bytes(), *sink);
  if (!recovery) {
    return cannot_open(recovery.error().text);
  }
  std::cout << describe(*recovery);
  return {};
}

/// The text of a report; empty, with a line on standard error, if it cannot be read.
std::string optional_text(const std::string& path) {
  if (path.empty()) {
    return {};
  }
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    std::cerr << "palp-review: report " << harmless_line(path)
              << " cannot be read; its values are null\n";
  }
  return {std::istreambuf_iterator<char>{file}, {}};
}

struct MetricsFlags {
  SessionPaths sessions;
  SessionPaths reports;
  std::string relay;
  std::string report;
  Asked asked;
};

ExitStatus run_metrics(const MetricsFlags& flags) {
  const auto surgeon = load_site(flags.sessions.surgeon, link::Role::Surgeon);
  const auto patient = load_site(flags.sessions.patient, link::Role::Patient);
  if (!surgeon || !patient) {
    return exit_status_of(!surgeon ? surgeon.error() : patient.error());
  }
  std::optional<judge::TissueTable> tissue;
  if (patient->tissue_csv) {
    auto table = judge::TissueTable::parse(*patient->tissue_csv);
    if (!table) {
      return bad_input(flags.sessions.patient + ": " + table.error().text);
    }
    tissue = std::move(*table);
  }
  const auto taps = match_taps(*surgeon, *patient, tissue ? &*tissue : nullptr);
  std::cout << tap_table(taps, overall_depth(taps));
  if (flags.report.empty()) {
    return {};
  }
  const ProgramReports reports{.surgeon = optional_text(flags.reports.surgeon),
                               .patient = optional_text(flags.reports.patient),
                               .relay = optional_text(flags.relay)};
  const auto document = demo_report(*surgeon, *patient, taps, flags.asked, reports, flags.sessions);
  if (const auto written = config::write_whole_file(flags.report, document); !written) {
    return cannot_open("--report: " + written.error().text);
  }
  return {};
}

void declare(config::CommandLine& line, MetricsFlags& flags) {
  line.text("--surgeon", flags.sessions.surgeon, "FILE", "session file of the surgeon's site");
  line.required();
  line.text("--patient", flags.sessions.patient, "FILE", "session file of the patient's site");
  line.required();
  line.text("--surgeon-report", flags.reports.surgeon, "FILE", "report that palp-surgeon wrote");
  line.text("--patient-report", flags.reports.patient, "FILE", "report that palp-patient wrote");
  line.text("--relay", flags.relay, "FILE", "report that palp-netem relay wrote");
  line.report(flags.report, "palp.demo/1");
  line.text("--outcome", flags.asked.outcome, "TEXT", "how the session ended");
  line.text("--preset", flags.asked.preset, "NAME", "link preset that was asked for");
  line.text("--grip", flags.asked.grip, "NAME", "grip that was asked for");
  const config::NumberRange span{.min = 0, .max = 1e6, .unit = "ms"};
  line.number("--rtt-ms", flags.asked.rtt_ms, span, "round trip that was asked for");
  line.number("--jitter-ms", flags.asked.jitter_ms, span, "jitter that was asked for");
  line.number("--loss", flags.asked.loss, {.min = 0, .max = 1, .unit = "share"}, "lost datagrams");
}

int run(int argc, char** argv) {
  config::CommandLine line{"palp-review", "what a session file says"};
  std::string in;
  std::string out;
  MetricsFlags flags;
  auto& info = line.verb("info", "duration, topics, counts, rates, drops, closed or not");
  auto& check = line.verb("check", "exit code 1 and the first fault, if there is one");
  auto& recovery = line.verb("recover", "write all that can be read of IN again, to OUT");
  for (config::CommandLine* verb : {&info, &check, &recovery}) {
    verb->argument(verb == &recovery ? "IN" : "FILE", in, "session file, never changed");
    verb->required();
  }
  recovery.argument("OUT", out, "new file; must not exist");
  recovery.required();
  declare(line.verb("metrics", "taps, depth and counters of a session"), flags);
  return config::run_program(line, argc, argv, [&] {
    const std::string verb = line.chosen_verb();
    if (verb == "info") return run_info(in);
    if (verb == "check") return run_check(in);
    return verb == "recover" ? run_recover(in, out) : run_metrics(flags);
  });
}

}  // namespace
}  // namespace palp::review

int main(int argc, char** argv) { return palp::review::run(argc, argv); }
