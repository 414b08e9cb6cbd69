// palp-review: reads session files. It is linked into no site.
#include <filesystem>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "common/config/command_line.h"
#include "common/config/exit_code.h"
#include "common/config/program_run.h"
#include "common/config/report.h"
#include "common/core/printable.h"
#include "common/core/whole_file.h"
#include "common/record/mapped_file.h"
#include "common/record/mcap_reader.h"
#include "common/record/session_encoder.h"
#include "review/check.h"
#include "review/compare.h"
#include "review/demo_report.h"
#include "review/export.h"
#include "review/info.h"
#include "review/map_drawing.h"
#include "review/merge.h"
#include "review/plot_command.h"
#include "review/recover.h"
#include "review/replay_command.h"
#include "review/report_curves.h"
#include "review/report_page.h"
#include "review/scenario_text.h"
#include "review/session_metrics.h"
#include "review/taps.h"
#include "review/text.h"
#include "review/time_line.h"

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
  if (file->bytes().empty()) {
    return fail(path + " is empty");
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
  const Checked found = checked(file->bytes());
  if (found.fault) {
    std::cout << harmless_line(path) << ": " << *found.fault << '\n';
    return {ExitCode::Missed, {}};
  }
  std::cout << harmless_line(path) << ": whole, closed, every message decodes"
            << (found.lack.empty() ? "" : "; the file " + found.lack) << '\n';
  return {};
}

ExitStatus run_recover(const std::string& in, const std::string& out) {
  const auto file = open_session(in);
  if (!file) {
    return exit_status_of(file.error());
  }
  if (!holds_message(file->bytes())) {
    return bad_input(in + ": there is no message in it, nothing can be recovered");
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
  auto text = read_whole_file(path);
  if (!text) {
    std::cerr << "palp-review: report " << harmless_line(path)
              << " cannot be read; its values are null\n";
  }
  return std::move(text).value_or("");
}

struct MergeFlags {
  SessionPaths sessions;
  std::string out;
};

ExitStatus run_merge(const MergeFlags& flags) {
  const auto session = load_pair(flags.sessions.surgeon, flags.sessions.patient);
  if (!session) return exit_status_of(session.error());
  const auto surgeon = open_session(flags.sessions.surgeon);
  const auto patient = open_session(flags.sessions.patient);
  if (!surgeon || !patient) return exit_status_of(!surgeon ? surgeon.error() : patient.error());
  auto sink = record::FileSink::create(flags.out);
  if (!sink) return cannot_open(sink.error().text);
  const auto merged = merge_files({surgeon->bytes(), patient->bytes()}, *session, *sink);
  if (!merged) return cannot_open(merged.error().text);
  std::cout << *merged << " messages on the surgeon's line of time, laid there by "
            << session->time_line.source;
  if (session->time_line.known) {
    std::cout << ", to " << fixed(seconds(session->time_line.uncertainty) * 1e3, 3) << " ms";
  }
  std::cout << '\n' << lack_lines(*session);
  return {};
}

void declare_pair(config::CommandLine& line, MergeFlags& flags) {
  line.argument("SURGEON", flags.sessions.surgeon, "session file of the surgeon's site");
  line.required();
  line.argument("PATIENT", flags.sessions.patient, "session file of the patient's site");
  line.required();
}

void declare(config::CommandLine& line, MergeFlags& flags) {
  declare_pair(line, flags);
  line.argument("OUT", flags.out, "new file; must not exist");
  line.required();
}

ExitStatus run_scenario(const MergeFlags& flags) {
  const auto session = load_pair(flags.sessions.surgeon, flags.sessions.patient);
  if (!session) return exit_status_of(session.error());
  // Wherever the lab is run.
  const auto text =
      scenario_text(*session, std::filesystem::absolute(flags.sessions.surgeon).string());
  if (!text) return bad_input(flags.sessions.patient + ": " + text.error().text);
  if (const auto written = config::write_whole_file(flags.out, *text); !written) {
    return cannot_open("--out: " + written.error().text);
  }
  std::cout << "scenario: " << harmless_line(flags.out) << "; palp-lab run plays it\n"
            << lack_lines(*session);
  return {};
}

struct ExportFlags {
  std::string file;
  std::string out;
  std::string topics;
  std::string format{"csv"};
  std::optional<double> from;
  std::optional<double> to;
};

ExitStatus run_export(const ExportFlags& flags) {
  const auto file = open_session(flags.file);
  if (!file) return exit_status_of(file.error());
  ExportAsk ask;
  ask.format = flags.format == "mat" ? ExportFormat::Mat : ExportFormat::Csv;
  ask.from = flags.from.value_or(-std::numeric_limits<double>::infinity());
  ask.to = flags.to;
  std::stringstream list{flags.topics};
  for (std::string topic; std::getline(list, topic, ',');) ask.topics.push_back(topic);
  const auto done = export_file(file->bytes(), ask, flags.out);
  if (!done) return config::refusal("palp-review", done.error());
  std::cout << done->messages << " messages in " << harmless_line(flags.out) << '\n';
  if (!done->lack.empty()) std::cout << "the file " << done->lack << '\n';
  return {};
}

void declare(config::CommandLine& line, ExportFlags& flags) {
  line.argument("FILE", flags.file, "session file, never changed");
  line.required();
  line.text(
      "--topics", flags.topics, "LIST", "surgeon/tick,surgeon/link: palp-review info lists them");
  line.required();
  line.text("--out", flags.out, "FILE", "new file; must not exist");
  line.required();
  line.choice(
      "--format", flags.format, {"csv", "mat"}, "csv: one topic; mat: MATLAB, Octave, R, Python");
  const config::NumberRange span{.min = 0, .max = 1e9, .unit = "s"};
  line.number("--from", flags.from, span, "since the file's first sample");
  line.number("--to", flags.to, span, "since the file's first sample; it is left out");
}

struct ReplayFlags {
  std::vector<std::string> files;
  std::string set;
  ReplayAsk ask;
};

ExitStatus run_replay(ReplayFlags& flags) {
  std::vector<record::MappedFile> files;
  RunBytes bytes;
  for (const std::string& path : flags.files) {
    auto file = open_session(path);
    if (!file) return exit_status_of(file.error());
    files.push_back(std::move(*file));
  }
  bytes.reserve(files.size());
  for (const record::MappedFile& file : files) bytes.push_back(file.bytes());
  if (!flags.set.empty()) flags.ask.set.push_back(flags.set);
  const auto answer = replay_command(bytes, flags.ask);
  if (!answer) return bad_input(flags.files.front() + ": " + answer.error().text);
  std::cout << answer->text;
  return {answer->same ? ExitCode::Done : ExitCode::Missed, {}};
}

void declare(config::CommandLine& line, ReplayFlags& flags) {
  line.arguments("FILE", flags.files, "session files of one run of a site, the first one first");
  line.required();
  line.text("--coupling",
            flags.ask.coupling,
            "NAME",
            "direct, wave, tdpa or mmt; of another than the session's the lab tells: scenario");
  line.choice("--estimator", flags.ask.estimator, {"bayes", "paper"}, "and this estimator?");
  line.text("--set", flags.set, "PATH=VALUE", "and with this setting of the site?");
}

struct MetricsFlags {
  SessionPaths sessions;
  SessionPaths reports;
  std::string relay;
  std::string report;
  std::string page;  ///< of HTML
  bool json{};
  Asked asked;
};

ExitStatus run_compare(const std::vector<std::string>& files) {
  if (files.size() % 2 != 0) {
    return bad_input("compare needs the files in pairs: surgeon, patient, surgeon, patient, ...");
  }
  std::vector<Compared> sessions;
  std::string lacks;
  for (std::size_t i = 0; i + 1 < files.size(); i += 2) {
    const auto session = load_pair(files[i], files[i + 1]);
    if (!session) return exit_status_of(session.error());
    lacks += lack_lines(*session);
    const auto tissue = tissue_of(session->patient, files[i + 1]);
    if (!tissue) return exit_status_of(tissue.error());
    sessions.push_back({.name = std::to_string(i / 2 + 1),
                        .coupling = session->surgeon.entry("coupling").value_or(""),
                        .metrics = judge_session(*session, *tissue ? &**tissue : nullptr).metrics});
  }
  std::cout << comparison_text(sessions) << lacks;
  return {};
}

ExitStatus run_metrics(const MetricsFlags& flags) {
  auto session = load_pair(flags.sessions.surgeon, flags.sessions.patient);
  if (!session) return exit_status_of(session.error());
  const SiteData* const surgeon = &session->surgeon;
  const SiteData* const patient = &session->patient;
  const auto tissue_told = tissue_of(*patient, flags.sessions.patient);
  if (!tissue_told) return exit_status_of(tissue_told.error());
  const std::optional<judge::TissueTable>& tissue = *tissue_told;
  ReportCurves curves;
  const JudgedSession judged =
      judge_session(*session, tissue ? &*tissue : nullptr, flags.page.empty() ? nullptr : &curves);
  Touches touches = match_taps(*surgeon, *patient, session->time_line, judged.excursions);
  if (judged.by_truth) take_truth(touches.taps, *session, judged.run_began, judged.metrics.taps);
  if (!flags.json && flags.page.empty()) {
    std::cout << tap_table(
        surgeon->began_at, touches, overall_depth(touches.taps), session->patient.map.report);
    std::cout << map_drawing(session->patient.map.report, session->patient.map.cells);
    std::cout << lack_lines(*session);
  }
  if (flags.report.empty() && flags.page.empty() && !flags.json) {
    return {};
  }
  const ProgramReports reports{.surgeon = optional_text(flags.reports.surgeon),
                               .patient = optional_text(flags.reports.patient),
                               .relay = optional_text(flags.relay)};
  if (const auto ours = check_reports(*session, reports); !ours) {
    return exit_status_of(ours.error());
  }
  const auto document =
      demo_report(*session, touches, flags.asked, reports, flags.sessions, metrics_json(judged));
  if (flags.json) std::cout << document;
  if (!flags.page.empty()) {
    const std::string page = report_page(*session, curves, document);
    if (const auto written = config::write_whole_file(flags.page, page); !written) {
      return cannot_open("--out: " + written.error().text);
    }
    std::cout << "report: " << harmless_line(flags.page) << '\n' << lack_lines(*session);
  }
  if (flags.report.empty()) return {};
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
  MergeFlags merge;
  declare(line.verb("merge", "both sites' files as one, on one line of time"), merge);
  MergeFlags scenario;
  auto& as_scenario = line.verb("scenario", "a session as a scenario that palp-lab run plays");
  declare_pair(as_scenario, scenario);
  as_scenario.output("--out", scenario.out, "text file; written over");
  as_scenario.required();
  ExportFlags exported;
  declare(line.verb("export", "numbers of chosen topics as CSV or MAT"), exported);
  ReplayFlags replay;
  declare(line.verb("replay", "do a site's ticks again; exit code 1 at the first difference"),
          replay);
  PlotFlags plotted;
  declare_plot(line.verb("plot", "hand and tip over time as a picture, for a paper"), plotted);
  std::vector<std::string> compared;
  auto& compare = line.verb("compare", "the metrics of several sessions side by side");
  compare.arguments("FILE", compared, "session files: surgeon, patient, surgeon, patient, ...");
  compare.required();
  auto& metrics = line.verb("metrics", "taps, depth, metrics and counters of a session");
  declare(metrics, flags);
  metrics.toggle("--json", flags.json, "print the report in place of the table");
  auto& report = line.verb("report", "a page of HTML that tells how the session went");
  declare(report, flags);
  report.output("--out", flags.page, "the page; written over");
  report.required();
  return config::run_program(line, argc, argv, [&] {
    const std::string verb = line.chosen_verb();
    if (verb == "info") return run_info(in);
    if (verb == "check") return run_check(in);
    if (verb == "compare") return run_compare(compared);
    if (verb == "merge") return run_merge(merge);
    if (verb == "scenario") return run_scenario(scenario);
    if (verb == "export") return run_export(exported);
    if (verb == "replay") return run_replay(replay);
    if (verb == "plot") return run_plot(plotted);
    return verb == "recover" ? run_recover(in, out) : run_metrics(flags);
  });
}

}  // namespace
}  // namespace palp::review

int main(int argc, char** argv) { return palp::review::run(argc, argv); }
