/// palp-lab: whole sessions in virtual time.

#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

#include <unistd.h>

#include "common/config/command_line.h"
#include "common/config/exit_code.h"
#include "common/config/program_run.h"
#include "common/config/report.h"
#include "common/config/submission.h"
#include "common/io/process/parallel.h"
#include "common/io/process/process_time.h"
#include "common/plot/picture.h"
#include "lab/depth_command.h"
#include "lab/impedance_command.h"
#include "lab/locate_command.h"
#include "lab/plan/plan.h"
#include "lab/plan/scenario_file.h"
#include "lab/report/run_report.h"
#include "lab/report/visibility.h"
#include "lab/run/run.h"
#include "lab/scenarios_command.h"
#include "lab/verbs.h"
#include "review/session_figure.h"
#include "site_program/build_info.h"

namespace palp::lab {
namespace {

using config::ExitCode;
using config::ExitStatus;

struct Arguments {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string coupling;
  std::string phantom;
  std::string report;
  std::string session_files;
  std::string trace;
  plot::PictureFlags picture;
  bool bare{};
};

Result<Scenario> scenario_of(const Arguments& arguments) {
  auto document = load_scenario(arguments.scenario);
  if (!document) return tl::unexpected(document.error());
  const auto set = [&](const std::string& path, const std::string& value, const char* flag) {
    return value.empty() ? Result<void>{} : document->set(path, value, flag);
  };
  const std::string seed = arguments.seed ? std::to_string(*arguments.seed) : "";
  for (const auto& done :
       {set("seed", seed, "--seed"),
        set("surgeon.coupling.name", arguments.coupling, "--coupling"),
        set("patient.coupling.name", arguments.coupling, "--coupling"),
        set("patient.simulated_phantom.phantom", arguments.phantom, "--phantom")}) {
    if (!done) return tl::unexpected(done.error());
  }
  if (auto checked = document->check(); !checked) return tl::unexpected(checked.error());
  auto scenario = make_scenario(arguments.scenario, *document);
  if (!scenario) return scenario;
  scenario->bare = arguments.bare;
  if (!scenario->phantom.caution.empty()) {
    std::fprintf(stderr, "palp-lab: warning: %s\n", scenario->phantom.caution.c_str());
  }
  return scenario;
}

/// Both files, or none.
struct SessionFiles {
  std::optional<record::FileSink> surgeon;
  std::optional<record::FileSink> patient;
};

Result<SessionFiles> open_files(const std::string& prefix) {
  SessionFiles files;
  if (prefix.empty()) return files;
  auto surgeon = record::FileSink::create(prefix + "surgeon.mcap");
  if (!surgeon) return tl::unexpected(surgeon.error());
  auto patient = record::FileSink::create(prefix + "patient.mcap");
  if (!patient) return tl::unexpected(patient.error());
  files.surgeon = std::move(*surgeon);
  files.patient = std::move(*patient);
  return files;
}

/// Of the first file that has one; empty: both are on the disk.
std::string recording_fault(SessionFiles& files) {
  std::string fault;
  for (auto* const file : {&files.surgeon, &files.patient}) {
    if (!*file) continue;
    (*file)->finish();
    if (fault.empty()) fault = (*file)->fault();
  }
  return fault;
}

/// A run that its duration ends is done; one that the operator gave up is not, whatever was felt
/// until then, nor one whose session files are not whole.
ExitStatus exit_status_of(surgeon::ScriptOutcome outcome,
                          const std::string& recording_fault,
                          const std::string& summary) {
  using surgeon::ScriptOutcome;
  const bool played = outcome == ScriptOutcome::Completed || outcome == ScriptOutcome::None;
  if (played && recording_fault.empty()) return {ExitCode::Done, summary};
  (void)std::fputs(summary.c_str(), stdout);
  std::string reason = "palp-lab: ";
  if (!played) {
    reason += "the script was not played to its end: " + std::string{surgeon::to_string(outcome)};
  }
  if (!recording_fault.empty()) {
    reason += (played ? "recording failed: " : "; recording failed: ") + recording_fault;
  }
  return {played ? ExitCode::Missed : ExitCode::CutShort, reason};
}

plot::Figure figure_of(const RunResult& result) {
  review::SessionFigure seen{review::FigureSpan{}};
  for (const judge::RunTick& tick : result.ticks) seen.see(tick);
  return seen.figure();
}

ExitStatus run(const Arguments& arguments) {
  const auto scenario = scenario_of(arguments);
  if (!scenario) return refusal(scenario.error());
  auto can = config::can_write_files({arguments.report, arguments.trace});
  if (can) can = plot::can_write_picture(arguments.picture);
  if (!can) {
    return {ExitCode::CannotOpen, "palp-lab: " + can.error().text};
  }
  auto files = open_files(arguments.session_files);
  if (!files) return {ExitCode::CannotOpen, "palp-lab: " + files.error().text};

  const io::ProcessTime begin = io::process_time();
  const RunResult result = simulate(*scenario,
                                    {.surgeon = files->surgeon ? &*files->surgeon : nullptr,
                                     .patient = files->patient ? &*files->patient : nullptr});
  const io::ProcessTime end = io::process_time();
  const RunAccount account{.scenario = arguments.scenario,
                           .cpu = seconds(end.cpu - begin.cpu),
                           .wall = seconds(end.wall - begin.wall),
                           .recording_fault = recording_fault(*files)};
  if (!arguments.report.empty()) {
    const auto written =
        config::write_whole_file(arguments.report, run_report(*scenario, result, account));
    if (!written) return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
  }
  if (!arguments.trace.empty()) {
    const auto written = config::write_whole_file(arguments.trace, trace_csv(result));
    if (!written) return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
  }
  if (arguments.picture.asked()) {
    const auto drawn = plot::write_picture(figure_of(result), arguments.picture);
    if (!drawn) return {ExitCode::CannotOpen, "palp-lab: " + drawn.error().text};
  }
  return exit_status_of(
      result.outcome, account.recording_fault, run_summary(*scenario, result, account));
}

/// Bits agree where these do, and mostly where they do not.
std::string made_by() {
  std::ifstream processors{"/proc/cpuinfo"};
  std::string processor = "unknown processor";
  for (std::string line; std::getline(processors, line);) {
    if (line.rfind("model name", 0) != 0 || line.find(": ") == std::string::npos) continue;
    processor = line.substr(line.find(": ") + 2);
    break;
  }
  return "commit " + std::string{site_program::git_commit()} + "; " +
         std::string{site_program::compiler()} + "; " + processor;
}

Machine machine() {
  return {.processors = io::processors(),
          .for_each_index = io::for_each_index,
          .used =
              [] {
                const io::ProcessTime used = io::process_time();
                return std::pair{seconds(used.cpu), seconds(used.wall)};
              },
          .watched = isatty(STDERR_FILENO) != 0,
          .made_by = made_by()};
}

}  // namespace
}  // namespace palp::lab

int main(int argc, char** argv) {
  palp::lab::Arguments arguments;
  palp::config::CommandLine line{"palp-lab",
                                 "Whole sessions in virtual time, repeatable to the bit."};
  auto& run = line.verb("run", "one scenario");
  run.argument("SCENARIO", arguments.scenario, "name (palp-lab scenarios) or text file");
  run.required();
  run.whole("--seed", arguments.seed, {.min = 0, .max = 9007199254740991}, "of everything random");
  run.text("--coupling",
           arguments.coupling,
           "NAME",
           "instead of the scenario's: direct, wave, tdpa or mmt");
  run.text("--phantom",
           arguments.phantom,
           "P",
           "instead of the scenario's: paper-5mm, paper-10mm, paper-15mm, paper-20mm, paper-25mm, "
           "none, closed-form[:DEPTH_MM], random:SEED, file:PATH or words: 'ball depth=12 radius=8 "
           "ratio=200'");
  run.toggle("--bare", arguments.bare, "raw telegrams, no session log: the laws alone");
  run.text("--session-files",
           arguments.session_files,
           "PREFIX",
           "keep the session files: PREFIXsurgeon.mcap, PREFIXpatient.mcap");
  run.report(arguments.report, "palp.run/1");
  run.output("--trace", arguments.trace, "every tick of the script as CSV");
  palp::plot::declare_picture(run, arguments.picture, "hand and tip over time");
  palp::lab::BatchArguments batch;
  palp::lab::declare_batch_verbs(line, batch);
  const palp::lab::ScenariosCommand scenarios{line};
  const palp::config::ProgressCommand progress{line};
  palp::lab::DepthFlags depth;
  declare_depth(line.verb("depth", "how well a depth is estimated, over many phantoms"), depth);
  palp::lab::LocateFlags locate;
  declare_locate(line.verb("locate", "how well taps at several places find a ball"), locate);
  palp::lab::ImpedanceFlags impedance;
  declare_impedance(line.verb("impedance", "what a coupling transmits, over frequency"), impedance);
  palp::lab::VisibilityFlags visible;
  declare_visible(line.verb("visible", "the smallest inclusion the sensor sees"), visible);
  return palp::config::run_program(line, argc, argv, [&]() -> palp::config::ExitStatus {
    const std::string verb = line.chosen_verb();
    for (const auto& submission : {batch.submission, depth.submission}) {
      if (!submission.engine.empty()) return palp::config::submit(submission, argc, argv);
    }
    if (verb == "progress") return progress.run();
    if (auto exit_status = palp::lab::run_batch_verb(verb, batch, palp::lab::machine()))
      return *exit_status;
    if (verb == "scenarios") return scenarios.run();
    if (verb == "depth") return palp::lab::run_depth(depth, palp::lab::machine());
    if (verb == "locate") return palp::lab::run_locate(locate, palp::lab::machine());
    if (verb == "impedance") return palp::lab::run_impedance(impedance, palp::lab::machine());
    if (verb == "visible") return palp::lab::run_visible(visible);
    return palp::lab::run(arguments);
  });
}
