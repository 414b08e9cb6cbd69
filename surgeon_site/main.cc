// palp-surgeon: the surgeon's site in real time.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/command_line.h"
#include "common/config/document.h"
#include "common/config/number.h"
#include "common/io/process/diagnostics.h"
#include "common/io/process/terminal.h"
#include "common/io/realtime/steady_clock.h"
#include "common/link/codec_wire.h"
#include "site_program/build_info.h"
#include "site_program/certificates_command.h"
#include "site_program/check_command.h"
#include "site_program/exit_status.h"
#include "site_program/impaired_reception.h"
#include "site_program/monitoring.h"
#include "site_program/peer_watch.h"
#include "site_program/recording.h"
#include "site_program/runner.h"
#include "site_program/session_info.h"
#include "site_program/site_address.h"
#include "site_program/site_main.h"
#include "site_program/site_report.h"
#include "site_program/status_line.h"
#include "surgeon_site/advice.h"
#include "surgeon_site/devices_command.h"
#include "surgeon_site/display.h"
#include "surgeon_site/hand_plan.h"
#include "surgeon_site/script_record.h"
#include "surgeon_site/session_end.h"
#include "surgeon_site/settings.h"
#include "surgeon_site/settings_devices.h"
#include "surgeon_site/study_port.h"
#include "surgeon_site/surgeon_node.h"

namespace palp::surgeon {
namespace {

using config::ExitCode;
using site_program::exit_status_of;
using site_program::ExitStatus;

constexpr Duration kDisplayPeriod = std::chrono::milliseconds{100};
constexpr Duration kStudyPeriod = std::chrono::milliseconds{10};  ///< a participant answers
constexpr Duration kDevicePause = std::chrono::milliseconds{20};

using StudyDescriptor = std::optional<std::uint64_t>;

void declare_flags(config::CommandLine& line,
                   config::Document& document,
                   std::string& report,
                   StudyDescriptor& study) {
  line.report(report, "palp.site/2");
  line.settings(document);
  line.knob("--peer", "peer");
  line.knob("--coupling", "coupling.name");
  line.knob("--master", "hand.master");
  line.knob("--devices", "devices");
  line.knob("--grip", "hand.grip");
  line.knob("--surface-offset-mm", "hand.surface_offset_mm");
  site_program::declare_session_flags(line);
  line.knob("--force-engage", "engagement.forced");
  line.knob("--picture-in-step", "picture_in_step");
  line.whole("--study-descriptor",
             study,
             {.min = 3, .max = 1024},
             "open pipe of the palp-study run that started this program");
}

/// What the parts are made of, all checked.
struct Plan {
  Settings settings;
  std::optional<GestureScript> script;  ///< of a simulated hand
  std::optional<MasterPlan> master;     ///< of a real one; neither: a pointer
  HandFacts facts;
  coupling::SurgeonCoupling law;
  site_program::RunnerConfig runner;
  record::SessionInfo info;
  std::optional<io::MessagePipe> study;  ///< who gives the trials of a study
};

/// Where somebody could look. A relay between the sites knows one address of each, that of force.
bool shows_camera(const Settings& settings) {
  return settings.monitor.serve && settings.protection.through.empty();
}

tl::expected<Plan, ExitStatus> make_plan(const config::Document& document,
                                         const StudyDescriptor& descriptor) {
  const auto bad = [](const Error& error) { return tl::unexpected{exit_status_of(error)}; };
  auto settings = make_settings(document);
  if (!settings) return bad(settings.error());
  std::optional<io::MessagePipe> study;
  if (descriptor) {
    auto pipe = io::MessagePipe::adopt(static_cast<int>(*descriptor));
    if (!pipe) return bad(pipe.error());
    study = std::move(*pipe);
  }
  if (settings->master == kPointerMaster || study) settings->monitor.serve = true;
  if (settings->picture_in_step && !shows_camera(*settings)) {
    return bad({"--picture-in-step needs --monitor, and no --through: elsewhere is no picture"});
  }
  const auto meeting = site_program::meeting_place("--peer", settings->peer, settings->protection);
  if (!meeting) return tl::unexpected{meeting.error()};
  if (*meeting) settings->peer = settings->protection.through;
  const auto address =
      site_program::site_address("--peer", settings->peer, settings->protection, 1);
  if (!address) return tl::unexpected{address.error()};
  auto hand = plan_hand(*settings);
  if (!hand) return bad(hand.error());
  auto law = coupling::make_surgeon_coupling(settings->coupling, hand->facts);
  if (!law) return bad(law.error());
  auto wrap = site_program::impaired_reception(
      settings->impairment, netem::Direction::Down, settings->seed, io::SteadyClock{}.now());
  if (!wrap) return bad(wrap.error());
  site_program::RunnerConfig runner;
  runner.session = {.role = link::Role::Surgeon,
                    .settings_hash = settings->agreement,
                    .coupling = settings->coupling.name,
                    .git = std::string{site_program::git_commit()},
                    .devices = {.hand = hand->facts, .stage = {}, .sensor = {}}};
  runner.address = *address;
  runner.meeting = *meeting;
  runner.protection = settings->protection;
  runner.wrap_transport = std::move(*wrap);
  runner.loop = settings->loop;
  runner.with_media = shows_camera(*settings);
  auto info =
      site_program::session_info(link::Role::Surgeon, "palp-surgeon", settings->seed, document);
  info.metadata.emplace_back("coupling", settings->coupling.name);
  info.metadata.emplace_back("master", settings->master);
  info.metadata.emplace_back("grip", settings->grip);
  info.metadata.emplace_back("surface_offset_mm",
                             config::number_text(settings->hand.person.surface_offset * 1e3));
  info.metadata.emplace_back("hand", describe(hand->facts));
  if (hand->script) describe_script(*hand->script, info);
  return Plan{std::move(*settings),
              std::move(hand->script),
              std::move(hand->master),
              hand->facts,
              std::move(*law),
              std::move(runner),
              std::move(info),
              std::move(study)};
}

/// A surgeon site in real time, its parts in the order in which they need each other.
/// Thread: main.
class Program {
 public:
  explicit Program(Plan plan)
      : settings_{std::move(plan.settings)},
        scripted_{make_scripted(settings_.hand, std::move(plan.script))},
        rig_{start_master(plan.master, settings_.loop.priority)},
        pointer_{make_pointer(settings_)},
        study_{plan.study ? std::make_unique<StudyPort>(std::move(*plan.study), hand()) : nullptr},
        law_{std::move(plan.law)},
        link_{settings_.link, std::make_unique<link::WireCodec>()},
        runner_{plan.runner},
        recording_{settings_.record,
                   proven(std::move(plan.info)),
                   1,
                   settings_.monitor.serve ? std::optional{settings_.loop.period} : std::nullopt,
                   shows_camera(settings_)},
        node_{settings_.node, {device(), law_, link_, recording_.recorder(0)}},
        monitoring_{settings_.monitor,
                    {{"coupling", settings_.coupling.name},
                     {"master", settings_.master},
                     {"version", std::string{site_program::version()}}},
                    recording_,
                    site_program::MonitoredSite{
                        .stops = &node_.stops(),
                        .pointer = pointer_ ? &pointer_->reports() : nullptr,
                        .media = shows_camera(settings_) ? &runner_.media_door() : nullptr,
                        .touch_hold = settings_.picture_in_step ? &node_.touch_hold() : nullptr,
                        .study = study_ ? &study_->screen() : nullptr}},
        began_at_{clock_.now()},
        watch_{{.peer = settings_.peer,
                .patience_at_first = settings_.link.closed_after,
                .patience = settings_.give_up_after,
                .round_trip_max = settings_.link.round_trip_max},
               began_at_} {}
  ~Program() { runner_.halt(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Shows how it goes until there is a reason to end.
  ExitStatus run(io::Terminal& terminal);
  /// Says goodbye and ends all threads; then the account is complete.
  void stop(site_program::SiteReport& report);

 private:
  [[nodiscard]] std::optional<ExitStatus> look(TimePoint now);
  /// nullopt: the master is ready.
  [[nodiscard]] std::optional<ExitStatus> await_master(io::Terminal& terminal);
  void tell_of_master();
  void tell_of_answers();
  void show(const SurgeonStatus& status, TimePoint now);

  [[nodiscard]] HapticDevice& hand() noexcept {
    if (rig_) return rig_->device();
    if (pointer_) return *pointer_;
    return *scripted_;
  }
  [[nodiscard]] HapticDevice& device() noexcept {
    if (study_) return study_->hand();
    return hand();
  }
  [[nodiscard]] record::SessionInfo proven(record::SessionInfo info) const {
    runner_.describe_identity(info);
    return info;
  }

  const Settings settings_;
  std::unique_ptr<SimulatedHand> scripted_;
  std::unique_ptr<MasterRig> rig_;
  std::unique_ptr<PointerHand> pointer_;  ///< one of these three
  std::unique_ptr<StudyPort> study_;      ///< null: no study asks
  std::uint32_t resets_{};
  coupling::SurgeonCoupling law_;
  link::Link link_;
  site_program::Runner runner_;
  site_program::Recording recording_;
  SurgeonNode node_;
  site_program::Monitoring monitoring_;
  io::SteadyClock clock_;
  TimePoint began_at_;
  site_program::PeerWatch watch_;
  StoppedPeerWatch stopped_peer_;
  site_program::StatusLine line_;
  site_program::RoundTrips round_trips_;
  Advice advice_{{.coupling = settings_.coupling.name,
                  .direct_round_trip_max = settings_.direct_round_trip_max,
                  .engagement_forced = settings_.engagement_forced}};
};

std::optional<ExitStatus> Program::await_master(io::Terminal& terminal) {
  while (rig_ && !rig_->ready()) {
    tell_of_master();
    if (auto why = rig_->hopeless(clock_.now() - began_at_)) {
      return site_program::cannot_start(std::move(*why));
    }
    if (terminal.wait_for_stop(kDevicePause)) {
      return ExitStatus{ExitCode::CutShort, "aborted", "aborted by the user"};
    }
  }
  return std::nullopt;
}

/// A button is pressed whether a study asks or not.
void Program::tell_of_answers() {
  const auto answer = rig_ ? rig_->take_answer() : std::nullopt;
  if (answer && study_) study_->tell_answer(*answer, clock_.now());
}

void Program::tell_of_master() {
  if (!rig_) return;
  if (const auto news = rig_->news()) {
    news->fit ? line_.info(news->sentence) : line_.warn(news->sentence);
  }
}

ExitStatus Program::run(io::Terminal& terminal) {
  if (pointer_ && !monitoring_.fault().empty()) {
    return site_program::cannot_start("no pointer without its page: " + monitoring_.fault());
  }
  if (auto ended = await_master(terminal)) return *ended;
  runner_.start(link_, [this](TimePoint now) { node_.tick(now); });
  for (const std::string& sentence : runner_.shortcomings()) line_.warn(sentence);
  monitoring_.announce(line_);
  if (study_) study_->tell_page(monitoring_.control_page());
  line_.info(
      "calling " + settings_.peer +
      (terminal.reads_keys() ? "; r resets a stop, m marks a moment, any other key ends" : ""));
  const Duration period = study_ ? kStudyPeriod : kDisplayPeriod;
  while (true) {
    const std::optional<io::StopCause> stop = terminal.wait_for_stop(period);
    monitoring_.look(recording_, clock_.now());
    monitoring_.tell_news(line_);
    recording_.mark(terminal.marks() + monitoring_.marks(), clock_.now());
    const std::uint32_t resets = terminal.resets() + monitoring_.resets();
    node_.commands().put({.emergency_stop = false, .resets = resets});
    // A reset frees the master first; the site hears of the next, once it is ready.
    const bool reset = std::exchange(resets_, resets) != resets;
    if (rig_ && reset) rig_->restart();
    tell_of_master();
    if (const auto exit_status = look(clock_.now())) return *exit_status;
    if (stop) return {ExitCode::CutShort, "aborted", "aborted by the user"};
    tell_of_answers();
    const bool over = study_ && !study_->look(node_.status().get(), recording_, clock_.now());
    if (over || monitoring_.end_asked()) return {ExitCode::Done, "ended", ""};
  }
}

std::optional<ExitStatus> Program::look(TimePoint now) {
  const SurgeonStatus& status = node_.status().get();
  round_trips_.add(status.link);
  const std::optional<std::string> hopeless = runner_.tell_news(line_);
  watch_.note_refusal(runner_.refusal());
  if (const auto peer = runner_.take_peer()) recording_.tell_of_peer(*peer);
  recording_.tell_news(line_);
  for (const std::string& sentence : advice_.news(status)) line_.warn(sentence);
  show(status, now);
  if (hopeless) return ExitStatus{ExitCode::CannotOpen, "refused", *hopeless};
  if (auto exit_status = end_of_script(status)) return exit_status;
  if (auto exit_status = watch_.judge(status.link, now)) return exit_status;
  if (auto exit_status = stopped_peer_.judge(status, scripted_ != nullptr, now)) {
    return exit_status;
  }
  if (settings_.duration == Duration{0} || now - began_at_ < settings_.duration) {
    return std::nullopt;
  }
  return watch_.ever_worked() ? end_of_time(status)
                              : watch_.unreachable(status.link, settings_.duration);
}

void Program::show(const SurgeonStatus& status, TimePoint now) {
  const std::string alarm = recording_.alarm();
  line_.show(alarm + status_line(status, line_.room_behind(alarm)), now);
}

void Program::stop(site_program::SiteReport& report) {
  runner_.stop(report.exit_status.reason.empty()
                   ? "the surgeon site has ended"
                   : "the surgeon site has ended: " + report.exit_status.reason);
  const SurgeonStatus& status = node_.status().get();
  show(status, clock_.now());
  report.link = status.link;
  report.round_trips = round_trips_;
  runner_.account(report);
  monitoring_.stop();
  report.records = recording_.stop(figures_of(report));
  recording_.tell_news(line_);
  line_.end();
}

}  // namespace

int run(int argc, char** argv) {
  config::Document document = config::surgeon_document();
  config::CommandLine line{"palp-surgeon", "The surgeon's site: a haptic device, a hand, a link."};
  std::string report_file;
  StudyDescriptor study;
  declare_flags(line, document, report_file, study);
  line.verbs_optional();
  const site_program::CertificatesCommand certificates{line};
  const site_program::CheckCommand check{line, link::Role::Surgeon};
  const DevicesCommand devices{line};
  const auto session = [&](site_program::SiteReport& report) {
    return site_program::run_session<Program>(make_plan(document, study), report);
  };
  const std::vector<site_program::SideVerb> verbs{
      {"certificates", [&] { return certificates.run(); }},
      {"check", [&] { return check.run(); }},
      {"devices", [&] { return devices.run(); }}};
  return site_program::run({"surgeon", line, report_file, verbs, session}, argc, argv);
}

}  // namespace palp::surgeon

int main(int argc, char** argv) {
  palp::io::start_diagnostics("palp-surgeon");
  return palp::surgeon::run(argc, argv);
}
