// palp-patient: the patient's site in real time.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/command_line.h"
#include "common/config/document.h"
#include "common/core/histogram.h"
#include "common/io/process/diagnostics.h"
#include "common/io/process/terminal.h"
#include "common/io/realtime/background_loop.h"
#include "common/io/realtime/steady_clock.h"
#include "common/link/codec_wire.h"
#include "patient_site/display.h"
#include "patient_site/estimator_worker.h"
#include "patient_site/patient_node.h"
#include "patient_site/phantom.h"
#include "patient_site/settings.h"
#include "patient_site/simulated_phantom.h"
#include "patient_site/tissue_record.h"
#include "site_program/build_info.h"
#include "site_program/check_command.h"
#include "site_program/exit_status.h"
#include "site_program/impaired_reception.h"
#include "site_program/recording.h"
#include "site_program/runner.h"
#include "site_program/session_info.h"
#include "site_program/site_address.h"
#include "site_program/site_main.h"
#include "site_program/site_report.h"
#include "site_program/status_line.h"

namespace palp::patient {
namespace {

using config::ExitCode;
using site_program::exit_status_of;
using site_program::ExitStatus;

constexpr Duration kDisplayPeriod = std::chrono::milliseconds{100};
constexpr Duration kEstimatorPause = std::chrono::milliseconds{1};  // of the 5 ms to an answer
constexpr std::size_t kContactSamples = 8192;  ///< 8 s: what a slow fit may take and far more

void declare_flags(config::CommandLine& line, config::Document& document, std::string& report) {
  line.text("--report", report, "FILE", "JSON report, written also when the run fails");
  line.settings(document);
  line.knob("--listen", "listen");
  line.knob("--coupling", "coupling.name");
  line.knob("--stage", "stage");
  line.knob("--force", "force");
  line.knob("--phantom", "simulated_phantom.phantom");
  line.knob("--surface-offset-mm", "simulated_phantom.surface_offset_mm");
  site_program::declare_session_flags(line);
}

/// What the parts are made of, all checked.
struct Plan {
  Settings settings;
  Phantom phantom;
  site_program::RunnerConfig runner;
  record::SessionInfo info;
};

tl::expected<Plan, ExitStatus> make_plan(const config::Document& document) {
  const auto bad = [](const Error& error) { return tl::unexpected{exit_status_of(error)}; };
  auto settings = make_settings(document);
  if (!settings) return bad(settings.error());
  const auto address =
      site_program::site_address("--listen", settings->listen, settings->protection, 0);
  if (!address) return tl::unexpected{address.error()};
  auto phantom = make_phantom(settings->phantom);
  if (!phantom) return bad(phantom.error());
  auto wrap = site_program::impaired_reception(
      settings->impairment, netem::Direction::Up, settings->seed, io::SteadyClock{}.now());
  if (!wrap) return bad(wrap.error());
  const SimulatedPhantomConfig& simulation = settings->simulation;
  settings->node.gate = within_tables(settings->node.gate,
                                      simulation.surface_offset - simulation.breathing_amplitude,
                                      phantom->depth_max());
  const PatientDevices devices = facts_of(simulation);
  site_program::RunnerConfig runner;
  runner.session = {.role = link::Role::Patient,
                    .settings_hash = settings->agreement,
                    .coupling = settings->coupling.name,
                    .git = std::string{site_program::git_commit()},
                    .devices = {.hand = {}, .stage = devices.stage, .sensor = devices.sensor}};
  runner.address = *address;
  runner.protection = settings->protection;
  runner.wrap_transport = std::move(*wrap);
  runner.loop = settings->loop;
  auto info =
      site_program::session_info(link::Role::Patient, "palp-patient", settings->seed, document);
  info.metadata.emplace_back("coupling", settings->coupling.name);
  info.metadata.emplace_back("estimator", settings->estimator_kind);
  info.metadata.emplace_back("stage", describe(devices.stage));
  info.metadata.emplace_back("force_sensor", describe(devices.sensor));
  describe_tissue(*phantom, simulation.surface_offset, settings->node.gate, info);
  return Plan{std::move(*settings), std::move(*phantom), std::move(runner), std::move(info)};
}

/// A patient site in real time, its parts in the order in which they need each other.
/// Thread: main.
class Program {
 public:
  explicit Program(Plan plan)
      : settings_{std::move(plan.settings)},
        phantom_{std::move(plan.phantom)},
        device_{phantom_, settings_.simulation},
        law_{coupling::make_patient_coupling(settings_.coupling, facts_of(settings_.simulation))
                 .value()},
        link_{settings_.link, std::make_unique<link::WireCodec>()},
        runner_{plan.runner},
        recording_{settings_.record, std::move(plan.info), 2},
        worker_{depth::with_sensor(settings_.estimator, device_.sensor_facts()),
                {contact_, depth_, recording_.recorder(1)}},
        node_{settings_.node,
              {device_, device_, law_, link_, recording_.recorder(0), contact_, depth_}},
        began_at_{clock_.now()},
        estimator_{"palp-estimator", kEstimatorPause, [this](TimePoint) { listen(); }} {
    runner_.start(link_, [this](TimePoint now) { node_.tick(now); });
  }
  ~Program() { runner_.halt(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Shows how it goes until there is a reason to end.
  ExitStatus run(io::Terminal& terminal);
  /// Says goodbye and ends all threads; then the account is complete.
  void stop(site_program::SiteReport& report);

 private:
  void look(TimePoint now);
  void listen();  ///< Thread: estimator
  [[nodiscard]] ExitStatus end(std::string outcome);

  const Settings settings_;
  const Phantom phantom_;
  SimulatedPhantom device_;
  coupling::PatientCoupling law_;
  link::Link link_;
  site_program::Runner runner_;
  site_program::Recording recording_;
  SpscQueue<ContactSample> contact_{kContactSamples};  ///< writer: rt, reader: estimator
  Mailbox<DepthEstimate> depth_;                       ///< writer: estimator, reader: rt
  EstimatorWorker worker_;
  PatientNode node_;
  io::SteadyClock clock_;
  TimePoint began_at_;
  site_program::StatusLine line_;
  site_program::RoundTrips round_trips_;
  Histogram latencies_;  ///< of estimates; written by the estimator's thread, read after its end
  io::BackgroundLoop estimator_;
};

ExitStatus Program::run(io::Terminal& terminal) {
  std::printf("listening on %s\n", runner_.local().c_str());
  std::fflush(stdout);
  for (const std::string& sentence : runner_.shortcomings()) line_.warn(sentence);
  while (true) {
    const std::optional<io::StopCause> stop = terminal.wait_for_stop(kDisplayPeriod);
    node_.commands().put({.emergency_stop = false, .resets = terminal.resets()});
    const TimePoint now = clock_.now();
    look(now);
    if (stop) return end(runner_.sessions() > 0 ? "completed" : "no session");
    if (settings_.duration > Duration{0} && now - began_at_ >= settings_.duration) {
      return end("duration reached");
    }
  }
}

void Program::look(TimePoint now) {
  const PatientStatus& status = node_.status().get();
  round_trips_.add(status.link);
  runner_.tell_news(line_);
  recording_.tell_news(line_);
  line_.show(recording_.alarm() + status_line(status), now);
}

void Program::listen() {
  const std::uint64_t before = worker_.strokes();
  worker_.drain();
  if (worker_.strokes() != before) {
    latencies_.record(elapsed(worker_.reversal_at(), clock_.now()));
  }
}

/// A patient site waits for surgeons until it is told to stop, so that is its normal end, unless it
/// had stopped itself. A surgeon's goodbye may still be on its way.
ExitStatus Program::end(std::string outcome) {
  const PatientStatus& status = node_.status().get();
  if (status.state == SiteState::Stopped) {
    return {ExitCode::CutShort,
            "stopped",
            "the site had stopped itself: " + std::string{record::to_string(status.reason)}};
  }
  return {ExitCode::Done, std::move(outcome), ""};
}

void Program::stop(site_program::SiteReport& report) {
  runner_.stop("the patient site has ended");
  estimator_.stop();
  const PatientStatus& status = node_.status().get();
  report.records = recording_.stop();
  recording_.tell_news(line_);
  line_.show(recording_.alarm() + status_line(status), clock_.now());
  line_.end();
  report.link = status.link;
  report.round_trips = round_trips_;
  report.estimates = worker_.strokes();
  report.estimate_p50 = latencies_.quantile(0.5);
  report.estimate_max = latencies_.max();
  runner_.account(report);
}

}  // namespace

int run(int argc, char** argv) {
  config::Document document = config::patient_document();
  config::CommandLine line{"palp-patient", "The patient's site: a stage, a force sensor, a link."};
  std::string report_file;
  declare_flags(line, document, report_file);
  line.verbs_optional();
  const site_program::CheckCommand check{line, link::Role::Patient};
  const auto session = [&](site_program::SiteReport& report) {
    return site_program::run_session<Program>(make_plan(document), report);
  };
  const std::vector<site_program::SideVerb> verbs{{"check", [&] { return check.run(); }}};
  return site_program::run({"patient", line, report_file, verbs, session}, argc, argv);
}

}  // namespace palp::patient

int main(int argc, char** argv) {
  palp::io::start_diagnostics("palp-patient");
  return palp::patient::run(argc, argv);
}
