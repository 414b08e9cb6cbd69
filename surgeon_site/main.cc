// palp-surgeon: the surgeon's site in real time.
#include <algorithm>
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
#include "surgeon_site/devices/master_rig.h"
#include "surgeon_site/devices_command.h"
#include "surgeon_site/display.h"
#include "surgeon_site/pointer_hand.h"
#include "surgeon_site/script_record.h"
#include "surgeon_site/script_source.h"
#include "surgeon_site/session_end.h"
#include "surgeon_site/settings.h"
#include "surgeon_site/settings_devices.h"
#include "surgeon_site/simulated_hand.h"
#include "surgeon_site/surgeon_node.h"

namespace palp::surgeon {
namespace {

using config::ExitCode;
using site_program::exit_status_of;
using site_program::ExitStatus;

constexpr Duration kDisplayPeriod = std::chrono::milliseconds{100};
constexpr Duration kDevicePause = std::chrono::milliseconds{20};
constexpr std::string_view kPointer = "pointer";  ///< the master that lies on the monitor's page

void declare_flags(config::CommandLine& line, config::Document& document, std::string& report) {
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
};

/// Where somebody could look. A relay between the sites knows one address of each, that of force.
bool shows_camera(const Settings& settings) {
  return settings.monitor.serve && settings.protection.through.empty();
}

/// Whose hand it is, of a person or of a script.
struct HandPlan {
  std::optional<GestureScript> script;
  std::optional<MasterPlan> master;
  HandFacts facts;
};

Result<HandPlan> plan_hand(const Settings& settings) {
  HandPlan hand;
  if (settings.master == kPointer) {
    hand.facts = facts_of(settings.hand);
    return hand;
  }
  const KnownMaster* const product = master_named(settings.master);
  if (product == nullptr) {
    auto script = load_script(settings.master, {settings.hand.plant.grip.stiffness, {}});
    if (!script) return tl::unexpected{script.error()};
    hand.script = std::move(*script);
    hand.facts = facts_of(settings.hand);
    return hand;
  }
  if (settings.devices.empty()) {
    return fail("master '" + settings.master + "' needs --devices FILE");
  }
  auto plan = read_master_plan(*product, settings.devices);
  if (!plan) return tl::unexpected{plan.error()};
  hand.facts = plan->facts;
  hand.master = std::move(*plan);
  return hand;
}

/// Null where the hand is a person's.
std::unique_ptr<SimulatedHand> make_scripted(const SimulatedHandConfig& hand,
                                             std::optional<GestureScript> script) {
  return script ? std::make_unique<SimulatedHand>(hand, std::move(*script)) : nullptr;
}

/// Null unless the hand is that of a pointer.
std::unique_ptr<PointerHand> make_pointer(const Settings& settings) {
  if (settings.master != kPointer) return nullptr;
  const SimulatedHandConfig& hand = settings.hand;
  return std::make_unique<PointerHand>(
      PointerHandConfig{.plant = hand.plant,
                        .encoder_step = hand.encoder_step,
                        .velocity_cut_off = hand.velocity_cut_off,
                        .force_max = hand.force_max,
                        .force_continuous = hand.force_continuous});
}

/// Started, not ready; null where the hand is no device's.
std::unique_ptr<MasterRig> start_master(const std::optional<MasterPlan>& plan, int priority) {
  return plan ? std::make_unique<MasterRig>(*plan, std::max(0, priority - 1)) : nullptr;
}

tl::expected<Plan, ExitStatus> make_plan(const config::Document& document) {
  const auto bad = [](const Error& error) { return tl::unexpected{exit_status_of(error)}; };
  auto settings = make_settings(document);
  if (!settings) return bad(settings.error());
  if (settings->master == kPointer) settings->monitor.serve = true;
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
              std::move(info)};
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
                        .media = shows_camera(settings_) ? &runner_.media_door() : nullptr}},
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
  void show(const SurgeonStatus& status, TimePoint now);

  [[nodiscard]] HapticDevice& device() noexcept {
    if (rig_) return rig_->device();
    if (pointer_) return *pointer_;
    return *scripted_;
  }
  [[nodiscard]] record::SessionInfo proven(record::SessionInfo info) const {
    runner_.describe_identity(info);
    return info;
  }

  const Settings settings_;
  std::unique_ptr<SimulatedHand> scripted_;
  std::unique_ptr<MasterRig> rig_;
  std::unique_ptr<PointerHand> pointer_;  ///< one of these three
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
  line_.info(
      "calling " + settings_.peer +
      (terminal.reads_keys() ? "; r resets a stop, m marks a moment, any other key ends" : ""));
  while (true) {
    const std::optional<io::StopCause> stop = terminal.wait_for_stop(kDisplayPeriod);
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
    if (monitoring_.end_asked()) return {ExitCode::Done, "ended", ""};
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
  declare_flags(line, document, report_file);
  line.verbs_optional();
  const site_program::CertificatesCommand certificates{line};
  const site_program::CheckCommand check{line, link::Role::Surgeon};
  const DevicesCommand devices{line};
  const auto session = [&](site_program::SiteReport& report) {
    return site_program::run_session<Program>(make_plan(document), report);
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
