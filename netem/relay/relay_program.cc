#include "netem/relay/relay_program.h"

#include <algorithm>
#include <climits>
#include <vector>

#include <poll.h>
#include <unistd.h>

#include "common/config/report.h"
#include "common/io/realtime/background_loop.h"
#include "netem/relay/control_folder.h"
#include "netem/relay/relay.h"
#include "netem/relay/relay_changes.h"
#include "netem/relay/relay_report.h"
#include "netem/syntax/impairment_text.h"

namespace palp::netem {
namespace {

/// Says it if there is room: who does not read the relay's output must not hold it up.
void say(int descriptor, const std::string& text) {
  pollfd ready{descriptor, POLLOUT, 0};
  if (::poll(&ready, 1, 0) <= 0 || (ready.revents & POLLOUT) == 0) return;
  // A pipe that is ready takes so much at once.
  (void)!::write(descriptor, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
}

/// Below the 80 of a site's control loop: the path must not delay the sites themselves.
constexpr int kPriority = 60;
/// Between two looks at control, recording and status.
constexpr Duration kPause = std::chrono::milliseconds{5};

/// Everything around the relay that may wait. Thread: the background loop's, once it runs.
class Attendant {
 public:
  Attendant(Relay& relay, const RelayProgramConfig& config)
      : relay_{relay},
        config_{config},
        changes_{relay, config.up, config.down, folder_.reader()},
        writer_{relay.recording, relay.start(), wall_now() - (monotonic_now() - relay.start())},
        status_at_{relay.start() + config.status_every} {}

  Result<void> open() {
    if (!config_.control.empty()) {
      if (!config_.control_folder.empty()) {
        auto folder = ControlFolder::open(config_.control_folder);
        if (!folder) return fail("--control-folder", folder.error());
        folder_ = *std::move(folder);
      }
      auto control = RelayControl::listen(config_.control, config_.control_token);
      if (!control) return fail("--control", control.error());
      control_.emplace(*std::move(control));
      say(STDOUT_FILENO, "control on " + control_->address() + '\n');
    }
    if (config_.record.empty()) return {};
    const auto opened = writer_.open(config_.record);
    return opened ? Result<void>{} : fail_to_reach(opened.error().text);
  }

  void work(TimePoint now) {
    if (control_) {
      control_->serve(
          [this](std::string_view line, std::uint64_t number) { return answer(line, number); });
      changes_.work(now, [this](std::uint64_t number, const std::string& text) {
        control_->reply(number, text);
      });
      for (const std::string& line : changes_.take_log()) say(STDOUT_FILENO, line);
    }
    writer_.drain();
    if (config_.status_every > Duration{} && now >= status_at_) {
      status_at_ += config_.status_every;
      say(STDOUT_FILENO, status_line(relay_.status.get(), relay_.start()) + '\n');
    }
  }

  Result<RecordingGaps> finish() { return writer_.close(); }
  [[nodiscard]] bool told_to_quit() const noexcept { return quit_; }

 private:
  std::optional<std::string> answer(std::string_view line, std::uint64_t number) {
    const auto request = changes_.read(line);
    if (!request) return error_line(request.error().text);
    switch (request->kind) {
      case ControlRequest::Kind::Stats: {
        const ControlContext laws = changes_.laws();
        return status_json(
            relay_.status.get(), relay_.start(), {to_string(laws.up), to_string(laws.down)});
      }
      case ControlRequest::Kind::Quit:
        quit_ = true;
        return "{\"quit\":true}";
      case ControlRequest::Kind::Record:
        return record(request->prefix);
      case ControlRequest::Kind::Change:
        break;
    }
    if (changes_.hold(*request, line, number)) return std::nullopt;
    return error_line("too many changes wait for their time");
  }

  std::string record(const std::string& prefix) {
    if (prefix.empty()) {
      const auto closed = writer_.close();
      return closed ? recording_end_line(*closed) : error_line(closed.error().text);
    }
    const auto opened =
        writer_.open(prefix, [this](const std::string& path) { return folder_.create(path); });
    return opened ? "{\"recording\":true}" : error_line(opened.error().text);
  }

  Relay& relay_;
  const RelayProgramConfig& config_;
  ControlFolder folder_;
  RelayChanges changes_;
  RecordingWriter writer_;
  std::optional<RelayControl> control_;
  TimePoint status_at_;
  std::atomic<bool> quit_{false};
};

/// Asked once in a while, so that a caller can end what no signal ends.
constexpr Duration kSlice = std::chrono::milliseconds{200};

}  // namespace

Result<void> run_relay(const RelayProgramConfig& config) {
  Relay relay{{.listen = config.listen,
               .forward = config.forward,
               .up = config.up,
               .down = config.down,
               .seed = config.seed,
               .priority = kPriority,
               .stop_descriptor = config.stop_descriptor}};
  RelayRun run{.preset = config.preset,
               .up = to_string(config.up.impairment),
               .down = to_string(config.down.impairment),
               .seed = config.seed,
               .forward = config.forward,
               .duration = {}};
  // Also at once: a path that cannot be written is known before the session.
  const auto write_report = [&]() -> Result<void> {
    if (config.report.empty()) return {};
    run.duration = monotonic_now() - relay.start();
    const auto written = config::write_whole_file(config.report, relay_report(relay, run));
    return written ? Result<void>{} : fail_to_reach(written.error().text);
  };
  if (auto written = write_report(); !written) return written;
  Attendant attendant{relay, config};
  if (auto opened = attendant.open(); !opened) return opened;
  say(STDOUT_FILENO,
      "listening on " + relay.listening_on().to_string() + "\nforwarding to " +
          run.forward.to_string() + "\nup   " + run.up + "\ndown " + run.down + '\n');
  {
    io::BackgroundLoop loop{"netem attendant", kPause, [&](TimePoint now) { attendant.work(now); }};
    const TimePoint until = monotonic_now() + config.duration;
    bool warned = false;
    while (!attendant.told_to_quit()) {
      const Duration left = until - monotonic_now();
      if (left <= Duration{} || !relay.serve(std::min(left, kSlice))) break;
      if (!relay.real_time() && !warned) {
        warned = true;
        say(STDERR_FILENO,
            "palp-netem: no right to SCHED_FIFO: releases may be late when the machine is busy\n");
      }
    }
    loop.stop();
  }
  const auto finished = attendant.finish();
  say(STDOUT_FILENO, relay_summary(relay));
  if (finished && finished->missed + finished->open > 0) {
    say(STDOUT_FILENO, "the recording lacks something: " + recording_end_line(*finished) + '\n');
  }
  if (auto written = write_report(); !written) return written;
  return finished ? Result<void>{} : fail_to_reach(finished.error().text);
}

}  // namespace palp::netem
