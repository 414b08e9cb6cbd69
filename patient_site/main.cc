// palp-patient: the patient's site in real time.
#include <algorithm>
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
#include "patient_site/captured_camera.h"
#include "patient_site/devices/device_rig.h"
#include "patient_site/devices_command.h"
#include "patient_site/display.h"
#include "patient_site/drawn_camera.h"
#include "patient_site/estimator_worker.h"
#include "patient_site/patient_node.h"
#include "patient_site/phantom.h"
#include "patient_site/settings.h"
#include "patient_site/settings_devices.h"
#include "patient_site/simulated_phantom.h"
#include "patient_site/tare_rule.h"
#include "patient_site/tissue_record.h"
#include "site_program/build_info.h"
#include "site_program/camera_sending.h"
#include "site_program/check_command.h"
#include "site_program/exit_status.h"
#include "site_program/impaired_reception.h"
#include "site_program/monitoring.h"
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
constexpr Duration kDevicePause = std::chrono::milliseconds{20};
constexpr Duration kEstimatorPause = std::chrono::milliseconds{1};  // of the 5 ms to an answer
constexpr Duration kDevicePatience = std::chrono::seconds{90};      // a drive that homes
constexpr std::size_t kContactSamples = 8192;  ///< 8 s: what a slow fit may take and far more

void declare_flags(config::CommandLine& line, config::Document& document, std::string& report) {
  line.report(report, "palp.site/2");
  line.settings(document);
  line.knob("--listen", "listen");
  line.knob("--coupling", "coupling.name");
  line.knob("--stage", "stage");
  line.knob("--force", "force");
  line.knob("--devices", "devices");
  line.knob("--phantom", "simulated_phantom.phantom");
  line.knob("--surface-offset-mm", "simulated_phantom.surface_offset_mm");
  line.knob("--camera", "camera.source");
  site_program::declare_session_flags(line);
}

/// What the parts are made of, all checked.
struct Plan {
  Settings settings;
  Phantom phantom;  ///< of simulated devices, or as known of real ones
  std::optional<DevicePlans> devices;
  PatientDevices facts;
  site_program::RunnerConfig runner;
  record::SessionInfo info;
  std::unique_ptr<video::Camera> camera;  ///< of a video device; null: another one or none
};

/// The simulated patient is that phantom, and the gate keeps within what is known of it.
Result<void> take_phantom(const Phantom& phantom, Settings& settings) {
  if (auto same = check_tip(settings, phantom); !same) return same;
  if (!phantom.caution.empty()) {
    std::fprintf(stderr, "palp-patient: warning: %s\n", phantom.caution.c_str());
  }
  const SimulatedPhantomConfig& simulation = settings.simulation;
  settings.node.gate =
      within_tables(settings.node.gate,
                    simulation.surface_offset -
                        simulation.breathing_amplitude * (1 + simulation.breathing_variation),
                    phantom.depth_max());
  return {};
}

/// As far as the settings say it.
site_program::RunnerConfig runner_of(const Settings& settings, const PatientDevices& facts) {
  site_program::RunnerConfig runner;
  runner.session = {.role = link::Role::Patient,
                    .settings_hash = settings.agreement,
                    .coupling = settings.coupling.name,
                    .git = std::string{site_program::git_commit()},
                    .devices = {.hand = {}, .stage = facts.stage, .sensor = facts.sensor}};
  runner.protection = settings.protection;
  runner.loop = settings.loop;
  runner.with_media = settings.camera.any();
  return runner;
}

tl::expected<Plan, ExitStatus> make_plan(const config::Document& document) {
  const auto bad = [](const Error& error) { return tl::unexpected{exit_status_of(error)}; };
  auto settings = make_settings(document);
  if (!settings) return bad(settings.error());
  const auto meeting =
      site_program::meeting_place("--listen", settings->listen, settings->protection);
  if (!meeting) return tl::unexpected{meeting.error()};
  HostAndPort local;  // where a relay is asked from: any
  if (!*meeting || !settings->listen.empty()) {
    const auto address =
        site_program::site_address("--listen", settings->listen, settings->protection, 0);
    if (!address) return tl::unexpected{address.error()};
    local = *address;
  }
  auto devices = plan_devices(*settings);
  if (!devices) return bad(devices.error());
  auto phantom = make_phantom(settings->phantom);
  if (!phantom) return bad(phantom.error());
  auto wrap = site_program::impaired_reception(
      settings->impairment, netem::Direction::Up, settings->seed, io::SteadyClock{}.now());
  if (!wrap) return bad(wrap.error());
  const SimulatedPhantomConfig& simulation = settings->simulation;
  const bool tissue_known = !*devices || !(*devices)->phantom.empty();
  if (!*devices) {
    if (const auto fits = take_phantom(*phantom, *settings); !fits) return bad(fits.error());
  }
  const PatientDevices facts = *devices ? facts_of(**devices) : facts_of(simulation);
  auto camera = open_camera(settings->camera.source);
  if (!camera) return bad(camera.error());
  site_program::RunnerConfig runner = runner_of(*settings, facts);
  runner.address = local;
  runner.meeting = *meeting;
  runner.wrap_transport = std::move(*wrap);
  auto info =
      site_program::session_info(link::Role::Patient, "palp-patient", settings->seed, document);
  info.metadata.emplace_back("coupling", settings->coupling.name);
  info.metadata.emplace_back("estimator", settings->estimator_kind);
  info.metadata.emplace_back("stage", describe(facts.stage));
  info.metadata.emplace_back("force_sensor", describe(facts.sensor));
  if (*devices) {
    info.attachments.push_back({"devices.textproto", "text/plain", (*devices)->text});
    info.metadata.emplace_back(kSensorStaleKey,
                               std::to_string(settings->node.sensor_stale.count()));
  }
  if (tissue_known) describe_tissue(*phantom, simulation.surface_offset, settings->node.gate, info);
  return Plan{std::move(*settings),
              std::move(*phantom),
              std::move(*devices),
              facts,
              std::move(runner),
              std::move(info),
              std::move(*camera)};
}

/// Started, not ready; null where there are none.
std::unique_ptr<DeviceRig> start_devices(const std::optional<DevicePlans>& plans, int priority) {
  return plans ? std::make_unique<DeviceRig>(*plans, std::max(0, priority - 1)) : nullptr;
}

/// A patient site in real time, its parts in the order in which they need each other.
/// Thread: main.
class Program {
 public:
  explicit Program(Plan plan)
      : settings_{std::move(plan.settings)},
        phantom_{std::move(plan.phantom)},
        simulated_{phantom_, settings_.simulation},
        rig_{start_devices(plan.devices, settings_.loop.priority)},
        law_{coupling::make_patient_coupling(settings_.coupling, plan.facts).value()},
        link_{settings_.link, std::make_unique<link::WireCodec>()},
        runner_{plan.runner},
        recording_{settings_.record,
                   proven(std::move(plan.info)),
                   2,
                   settings_.monitor.serve ? std::optional{settings_.loop.period} : std::nullopt,
                   settings_.camera.any()},
        worker_{depth::with_devices(settings_.estimator, plan.facts),
                {contact_, found_, cells_, recording_.recorder(1)}},
        node_{settings_.node,
              {rig_ ? rig_->stage() : simulated_,
               rig_ ? rig_->sensor() : simulated_,
               law_,
               link_,
               recording_.recorder(0),
               contact_,
               found_,
               cells_}},
        monitoring_{settings_.monitor,
                    {{"coupling", settings_.coupling.name},
                     {"version", std::string{site_program::version()}}},
                    recording_,
                    std::nullopt},
        camera_{make_camera(std::move(plan.camera),
                            settings_.camera.source,
                            settings_.camera.any() ? &recording_.camera()->force().tip() : nullptr,
                            settings_.simulation.surface_offset)},
        began_at_{clock_.now()},
        estimator_{"palp-estimator", kEstimatorPause, [this](TimePoint) { listen(); }} {}
  ~Program() { runner_.halt(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Shows how it goes until there is a reason to end.
  ExitStatus run(io::Terminal& terminal);
  /// Says goodbye and ends all threads; then the account is complete.
  void stop(site_program::SiteReport& report);

 private:
  /// nullopt: they are ready.
  [[nodiscard]] std::optional<ExitStatus> await_devices(io::Terminal& terminal);
  void tell_of_devices();
  void tare();
  void look(TimePoint now);
  void show(const PatientStatus& status, TimePoint now);
  void listen();  ///< Thread: estimator
  [[nodiscard]] ExitStatus end(std::string outcome);

  [[nodiscard]] record::SessionInfo proven(record::SessionInfo info) const {
    runner_.describe_identity(info);
    return info;
  }

  const Settings settings_;
  const Phantom phantom_;
  SimulatedPhantom simulated_;
  std::unique_ptr<DeviceRig> rig_;  ///< null: the simulated one
  std::uint32_t resets_{};
  std::uint32_t tares_{};
  coupling::PatientCoupling law_;
  link::Link link_;
  site_program::Runner runner_;
  site_program::Recording recording_;
  SpscQueue<ContactSample> contact_{kContactSamples};  ///< writer: rt, reader: estimator
  Mailbox<Findings> found_;                            ///< writer: estimator, reader: rt
  Mailbox<MapCells> cells_;                            ///< likewise
  EstimatorWorker worker_;
  PatientNode node_;
  site_program::Monitoring monitoring_;
  std::unique_ptr<video::Camera> camera_;  ///< null: none
  io::SteadyClock clock_;
  TimePoint began_at_;
  site_program::StatusLine line_;
  site_program::RoundTrips round_trips_;
  Histogram latencies_;  ///< of estimates; written by the estimator's thread, read after its end
  io::BackgroundLoop estimator_;
  std::unique_ptr<site_program::CameraSending> sending_;  ///< null: nothing is sent
};

std::optional<ExitStatus> Program::await_devices(io::Terminal& terminal) {
  while (rig_ && !rig_->ready()) {
    tell_of_devices();
    if (auto why = rig_->hopeless(clock_.now() - began_at_)) {
      return site_program::cannot_start(std::move(*why));
    }
    if (terminal.wait_for_stop(kDevicePause)) return end("no session");
  }
  return std::nullopt;
}

void Program::tell_of_devices() {
  if (!rig_) return;
  for (const DeviceNews& news : rig_->news()) {
    news.fit ? line_.info(news.sentence) : line_.warn(news.sentence);
  }
}

void Program::tare() {
  if (!rig_) return line_.info("a simulated sensor needs no tare");
  if (const auto why = why_no_tare(node_.status().get())) {
    return line_.warn("the tare was refused: " + std::string{*why});
  }
  rig_->tare();
}

ExitStatus Program::run(io::Terminal& terminal) {
  if (auto ended = await_devices(terminal)) return *ended;
  if (camera_) {
    sending_ = std::make_unique<site_program::CameraSending>(
        site_program::CameraSendingConfig{.jpeg = settings_.camera.jpeg,
                                          .max_kbps = settings_.camera.rate_max_kbps},
        *camera_,
        runner_.media_door(),
        *recording_.camera());
  }
  runner_.start(link_, [this](TimePoint now) { node_.tick(now); });
  std::printf("listening on %s\n", runner_.local().c_str());
  std::fflush(stdout);
  for (const std::string& sentence : runner_.shortcomings()) line_.warn(sentence);
  monitoring_.announce(line_);
  while (true) {
    const std::optional<io::StopCause> stop = terminal.wait_for_stop(kDisplayPeriod);
    recording_.mark(terminal.marks(), clock_.now());
    node_.commands().put({.emergency_stop = false, .resets = terminal.resets()});
    // A reset frees the devices first; the site hears of the next, once they are ready.
    if (rig_ && std::exchange(resets_, terminal.resets()) != resets_) rig_->restart();
    if (std::exchange(tares_, terminal.tares()) != tares_) tare();
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
  if (const auto peer = runner_.take_peer()) recording_.tell_of_peer(*peer);
  recording_.tell_news(line_);
  monitoring_.tell_news(line_);
  if (sending_) sending_->tell_news(line_);
  tell_of_devices();
  show(status, now);
}

void Program::listen() {
  const std::uint64_t before = worker_.strokes();
  worker_.drain();
  if (worker_.strokes() != before) {
    latencies_.record(elapsed(worker_.reversal_at(), clock_.now()));
    worker_.judge_map();
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

void Program::show(const PatientStatus& status, TimePoint now) {
  const std::string alarm = recording_.alarm();
  line_.show(alarm + status_line(status, line_.room_behind(alarm)), now);
}

void Program::stop(site_program::SiteReport& report) {
  sending_.reset();
  runner_.stop("the patient site has ended");
  estimator_.stop();
  const PatientStatus& status = node_.status().get();
  report.link = status.link;
  report.round_trips = round_trips_;
  report.estimates = worker_.strokes();
  report.estimate_p50 = latencies_.quantile(0.5);
  report.estimate_max = latencies_.max();
  runner_.account(report);
  monitoring_.stop();
  report.records = recording_.stop(figures_of(report));
  recording_.tell_news(line_);
  show(status, clock_.now());
  line_.end();
}

}  // namespace

int run(int argc, char** argv) {
  config::Document document = config::patient_document();
  config::CommandLine line{"palp-patient", "The patient's site: a stage, a force sensor, a link."};
  std::string report_file;
  declare_flags(line, document, report_file);
  line.verbs_optional();
  const site_program::CheckCommand check{line, link::Role::Patient};
  const DevicesCommand devices{line};
  const auto session = [&](site_program::SiteReport& report) {
    return site_program::run_session<Program>(make_plan(document), report);
  };
  const std::vector<site_program::SideVerb> verbs{{"check", [&] { return check.run(); }},
                                                  {"devices", [&] { return devices.run(); }}};
  return site_program::run({"patient", line, report_file, verbs, session}, argc, argv);
}

}  // namespace palp::patient

int main(int argc, char** argv) {
  palp::io::start_diagnostics("palp-patient");
  return palp::patient::run(argc, argv);
}
