#include "study/real_sites/site_session.h"

#include <filesystem>
#include <utility>
#include <vector>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "common/core/whole_file.h"

namespace palp::study {
namespace {

using config::Json;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kStart = seconds{20};
constexpr Duration kLook = milliseconds{20};
constexpr Duration kEnd = seconds{10};

/// The reason that a program gave as it ended, and nothing of what it said before: that names
/// forces, places, the link.
std::string reason_in(const std::string& log) {
  std::string text = read_whole_file(log).value_or(std::string{});
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::string line = text.substr(text.rfind('\n') + 1);
  return line.starts_with("palp-") ? ": " + line : "";
}

/// What stands behind "listening on ", once it is there.
std::optional<std::string> address_in(const std::string& log) {
  constexpr std::string_view kMark = "listening on ";
  const std::string text = read_whole_file(log).value_or(std::string{});
  const std::size_t at = text.find(kMark);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + kMark.size();
  const std::size_t end = text.find_first_of(" ,\n", begin);
  if (end == std::string::npos) return std::nullopt;
  return text.substr(begin, end - begin);
}

Result<void> write_inputs(const Condition& condition, const SiteSetting& setting) {
  const std::string surgeon =
      "impairment {" + condition.down + "}\n" +
      (gives_force(condition.feedback) ? "" : "force_gate { force_max_n: 0 }\n");
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"/tray.csv", setting.tissue},
                                   {"/patient.textproto", "impairment {" + condition.up + "}\n"},
                                   {"/surgeon.textproto", surgeon}}) {
    if (auto written = config::write_whole_file(setting.work + name, text); !written) {
      return tl::unexpected(written.error());
    }
  }
  return {};
}

/// Nobody is to read them while trials are given.
void forget_inputs(const SiteSetting& setting) {
  for (const char* const name : {"/tray.csv", "/patient.textproto", "/surgeon.textproto"}) {
    std::error_code ignored;
    std::filesystem::remove(setting.work + name, ignored);
  }
}

/// Where a program listens, once it says so; nothing: it does not start.
/// `pipe`: to wait by.
std::optional<std::string> listens(io::ChildProgram& program,
                                   const std::string& log,
                                   io::MessagePipe& pipe) {
  for (Duration waited{}; waited < kStart && program.running(); waited += kLook) {
    if (auto address = address_in(log)) return address;
    pipe.wait(kLook);
  }
  return std::nullopt;
}

std::vector<std::string> patient_command(const Condition& condition, const SiteSetting& setting) {
  return {setting.programs + "/palp-patient",
          "--insecure",
          "--listen",
          "127.0.0.1:0",
          "--coupling",
          condition.coupling,
          "--phantom",
          "file:" + setting.work + "/tray.csv",
          "--config",
          setting.work + "/patient.textproto",
          "--session-file",
          setting.traces + "_patient.mcap"};
}

std::vector<std::string> surgeon_command(const Condition& condition,
                                         const SiteSetting& setting,
                                         const std::string& peer) {
  std::vector<std::string> words{setting.programs + "/palp-surgeon",
                                 "--insecure",
                                 "--peer",
                                 peer,
                                 "--coupling",
                                 condition.coupling,
                                 "--grip",
                                 condition.grip,
                                 "--master",
                                 setting.hand.master,
                                 "--config",
                                 setting.work + "/surgeon.textproto",
                                 "--session-file",
                                 setting.traces + "_surgeon.mcap",
                                 "--monitor-port",
                                 std::to_string(setting.hand.monitor_port),
                                 "--study-descriptor",
                                 std::to_string(io::ChildProgram::kPipeNumber)};
  if (!setting.hand.devices.empty()) {
    words.emplace_back("--devices");
    words.push_back(setting.hand.devices);
  }
  return words;
}

}  // namespace

Result<SiteSession> SiteSession::start(const Condition& condition, const SiteSetting& setting) {
  if (auto written = write_inputs(condition, setting); !written) {
    return tl::unexpected(written.error());
  }
  auto pipes = io::MessagePipe::make();
  if (!pipes) return tl::unexpected(pipes.error());
  const std::string patient_log = setting.work + "/patient.log";
  const std::string log = setting.work + "/surgeon.log";
  auto patient = io::ChildProgram::start(patient_command(condition, setting), patient_log);
  if (!patient) return tl::unexpected(patient.error());
  std::optional<std::string> peer = listens(*patient, patient_log, pipes->first);
  if (!peer) return fail_to_reach("the patient's site does not start" + reason_in(patient_log));
  std::optional<Relay> relay;
  if (setting.changes_delay) {
    auto started = start_relay(setting, *peer, pipes->first);
    if (!started) return tl::unexpected(started.error());
    relay = std::move(*started);
    peer = relay->address;
  }
  auto surgeon =
      io::ChildProgram::start(surgeon_command(condition, setting, *peer), log, &pipes->second);
  if (!surgeon) return tl::unexpected(surgeon.error());
  SiteSession session{std::move(*patient), std::move(*surgeon), std::move(pipes->first)};
  session.log_ = log;
  session.relay_ = std::move(relay);
  for (Duration waited{}; waited < kStart && session.page_.empty(); waited += kLook) {
    const bool running = session.surgeon_.running();
    session.listen();  // also to what a program said before it ended
    if (!running) break;
  }
  if (session.page_.empty()) {
    return fail_to_reach("the surgeon's site does not start" + reason_in(log));
  }
  forget_inputs(setting);
  return session;
}

Result<SiteSession::Relay> SiteSession::start_relay(const SiteSetting& setting,
                                                    const std::string& patient,
                                                    io::MessagePipe& pipe) {
  const std::string log = setting.work + "/relay.log";
  const std::string control = setting.work + "/relay";
  auto program = io::ChildProgram::start({setting.programs + "/palp-netem",
                                          "relay",
                                          "--listen",
                                          "127.0.0.1:0",
                                          "--forward",
                                          patient,
                                          "--control",
                                          "unix:" + control},
                                         log);
  if (!program) return tl::unexpected(program.error());
  const auto address = listens(*program, log, pipe);
  if (!address) return fail_to_reach("the relay does not start" + reason_in(log));
  auto line = RelayLine::connect(control);
  if (!line) return tl::unexpected(line.error());
  return Relay{std::move(*program), std::move(*line), *address};
}

void SiteSession::delay(double milliseconds) {
  if (!relay_ || milliseconds == delay_) return;
  delay_ = milliseconds;
  (void)relay_->line.delay(milliseconds);
}

void SiteSession::listen() {
  if (!pipe_) return;
  pipe_->wait(kLook);
  while (const auto message = pipe_->receive()) hear(*message);
}

void SiteSession::hear(const std::string& message) {
  const Json said = Json::parse(message);
  const auto number = [&said](std::string_view name) {
    return said.at_or_null(name).number().value_or(0);
  };
  const TimePoint at{Duration{static_cast<std::int64_t>(number("at_ns"))}};
  if (const auto page = said.at_or_null("page").text()) {
    page_ = *page;
  } else if (said.contains("answer")) {
    const SiteAnswer answer{.trial = static_cast<std::uint32_t>(number("trial")),
                            .choice = static_cast<std::uint32_t>(number("answer")),
                            .at = at};
    // The first one counts, and only a whole number is one.
    if (!answer_ && number("answer") == answer.choice) answer_ = answer;
  } else if (said.contains("engaged")) {
    news_ = {.engaged = said["engaged"].truth().value_or(false),
             .force = number("force_n"),
             .contact_force = number("contact_n"),
             .stands = {number("x_mm") / 1e3, number("y_mm") / 1e3}};
  }
}

std::optional<SiteAnswer> SiteSession::take_answer() noexcept {
  return std::exchange(answer_, std::nullopt);
}

void SiteSession::send_place(const StagePlace& place) {
  if (!pipe_) return;
  const Json there{{"x_mm", place.place.x / kMillimetre},
                   {"y_mm", place.place.y / kMillimetre},
                   {"reach_mm", place.reach / kMillimetre}};
  (void)pipe_->send(Json{{"place", there}}.dump());
}

void SiteSession::show(const std::string& view) {
  if (pipe_) (void)pipe_->send("{\"show\":" + view + "}");
}

void SiteSession::note(record::NoteCode code, double detail, TimePoint at) {
  if (!pipe_) return;
  (void)pipe_->send(Json{{"note", static_cast<std::uint16_t>(code)},
                         {"detail", detail},
                         {"at_ns", at.time_since_epoch().count()}}
                        .dump());
}

std::optional<Error> SiteSession::fault() {
  if (!surgeon_.running()) return Error{"the surgeon's site has ended" + reason_in(log_)};
  if (!patient_.running()) return Error{"the patient's site has ended"};
  if (relay_ && !relay_->program.running()) return Error{"the relay between the sites has ended"};
  return std::nullopt;
}

void SiteSession::stop() {
  pipe_.reset();  // which ends the surgeon's site
  (void)surgeon_.ends_within(kEnd);
  surgeon_.stop(kEnd);
  patient_.stop(kEnd);
  if (relay_) relay_->program.stop(kEnd);
}

}  // namespace palp::study
