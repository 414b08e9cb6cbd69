// palp-review: reads session files. It is linked into no site.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include <CLI/CLI.hpp>

#include "common/record/mapped_file.h"
#include "review/check.h"
#include "review/demo_report.h"
#include "review/info.h"
#include "review/recover.h"
#include "review/report_file.h"
#include "review/taps.h"

namespace palp::review {
namespace {

// Exit codes of every program of this house.
constexpr int kDone = 0;
constexpr int kMissed = 1;      ///< ran, but a check failed
constexpr int kBadInput = 2;    ///< flag, field or content
constexpr int kNotReached = 3;  ///< could not be opened

int complain(int code, const std::string& text) {
  std::cerr << "palp-review: " << text << '\n';
  return code;
}

int run_info(const std::string& path) {
  const auto file = record::MappedFile::open(path);
  if (!file) {
    return complain(kNotReached, file.error().text);
  }
  std::cout << describe(file->bytes());
  return kDone;
}

int run_check(const std::string& path) {
  const auto file = record::MappedFile::open(path);
  if (!file) {
    return complain(kNotReached, file.error().text);
  }
  if (const auto fault = first_fault(file->bytes())) {
    std::cout << path << ": " << *fault << '\n';
    return kMissed;
  }
  std::cout << path << ": whole, closed, every message decodes\n";
  return kDone;
}

int run_recover(const std::string& in, const std::string& out) {
  const auto file = record::MappedFile::open(in);
  if (!file) {
    return complain(kNotReached, file.error().text);
  }
  auto sink = record::FileSink::create(out);
  if (!sink) {
    return complain(kNotReached, sink.error().text);
  }
  const auto recovery = recover(file->bytes(), *sink);
  if (!recovery) {
    return complain(kNotReached, recovery.error().text);
  }
  std::cout << describe(*recovery);
  return kDone;
}

/// The text of a report; empty, with a line on standard error, if it cannot be read.
std::string optional_text(const std::string& path) {
  if (path.empty()) {
    return {};
  }
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    std::cerr << "palp-review: report " << path << " cannot be read; its values are null\n";
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

int run_metrics(const MetricsFlags& flags) {
  const auto surgeon = load_site(flags.sessions.surgeon, link::Role::Surgeon);
  const auto patient = load_site(flags.sessions.patient, link::Role::Patient);
  if (!surgeon || !patient) {
    return complain(kBadInput, !surgeon ? surgeon.error().text : patient.error().text);
  }
  std::optional<TissueTable> tissue;
  if (patient->tissue_csv) {
    auto table = TissueTable::parse(*patient->tissue_csv);
    if (!table) {
      return complain(kBadInput, flags.sessions.patient + ": " + table.error().text);
    }
    tissue = std::move(*table);
  }
  const auto taps = match_taps(*surgeon, *patient, tissue ? &*tissue : nullptr);
  std::cout << tap_table(taps, judge_depth(taps));
  if (flags.report.empty()) {
    return kDone;
  }
  const ProgramReports reports{.surgeon = optional_text(flags.reports.surgeon),
                               .patient = optional_text(flags.reports.patient),
                               .relay = optional_text(flags.relay)};
  const auto document = demo_report(*surgeon, *patient, taps, flags.asked, reports, flags.sessions);
  if (const auto error = write_whole(flags.report, document)) {
    return complain(kNotReached, error->text);
  }
  return kDone;
}

void add_metrics_flags(CLI::App& verb, MetricsFlags& flags) {
  verb.add_option("--surgeon", flags.sessions.surgeon, "session file of the surgeon's site")
      ->required();
  verb.add_option("--patient", flags.sessions.patient, "session file of the patient's site")
      ->required();
  verb.add_option("--surgeon-report", flags.reports.surgeon, "report that palp-surgeon wrote");
  verb.add_option("--patient-report", flags.reports.patient, "report that palp-patient wrote");
  verb.add_option("--relay", flags.relay, "report that palp-netem relay wrote");
  verb.add_option("--report", flags.report, "write palp.demo/1 to this file");
  verb.add_option("--outcome", flags.asked.outcome, "how the session ended");
  verb.add_option("--preset", flags.asked.preset, "link preset that was asked for");
  verb.add_option("--grip", flags.asked.grip, "grip that was asked for");
  verb.add_option("--rtt-ms", flags.asked.rtt_ms, "round trip that was asked for");
  verb.add_option("--jitter-ms", flags.asked.jitter_ms, "jitter that was asked for");
  verb.add_option("--loss", flags.asked.loss, "share of datagrams lost that was asked for");
}

int run(int argc, char** argv) {
  CLI::App app{"palp-review: what a session file says"};
  app.require_subcommand(1);
  std::string in;
  std::string out;
  MetricsFlags flags;
  auto* info = app.add_subcommand("info", "duration, topics, counts, rates, drops, closed or not");
  auto* check = app.add_subcommand("check", "exit code 1 and the first fault, if there is one");
  auto* recovery = app.add_subcommand("recover", "write all that can be read of IN again, to OUT");
  auto* metrics = app.add_subcommand("metrics", "taps, depth and counters of a session");
  for (CLI::App* verb : {info, check, recovery}) {
    verb->add_option("FILE", in, "session file, never changed")->required();
  }
  recovery->add_option("OUT", out, "new file; must not exist")->required();
  add_metrics_flags(*metrics, flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  if (info->parsed()) {
    return run_info(in);
  }
  if (check->parsed()) {
    return run_check(in);
  }
  return recovery->parsed() ? run_recover(in, out) : run_metrics(flags);
}

}  // namespace
}  // namespace palp::review

int main(int argc, char** argv) {
  try {
    return palp::review::run(argc, argv);
  } catch (const std::exception& error) {
    return palp::review::complain(palp::review::kNotReached, error.what());
  }
}
