#include "netem/relay_program.h"

#include <cstdio>
#include <vector>

#include "common/config/report.h"
#include "common/io/background_loop.h"
#include "netem/relay.h"
#include "netem/relay_report.h"

namespace palp::netem {
namespace {

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
        context_{.up = config.up.impairment, .down = config.down.impairment},
        writer_{relay.recording, relay.start(), wall_now() - (monotonic_now() - relay.start())},
        status_at_{relay.start() + config.status_every} {}

  Result<void> open() {
    if (!config_.control.empty()) {
      auto control = RelayControl::listen(config_.control);
      if (!control) return fail("--control: " + control.error().text);
      control_.emplace(*std::move(control));
      std::printf("control on %s\n", control_->address().c_str());
    }
    return config_.record.empty() ? Result<void>{} : writer_.open(config_.record);
  }

  void work(TimePoint now) {
    if (control_) control_->serve([this](std::string_view line) { return answer(line); });
    log_applied();
    writer_.drain();
    if (config_.status_every > Duration{} && now >= status_at_) {
      status_at_ += config_.status_every;
      std::printf("%s\n", status_line(relay_.status.get(), relay_.start()).c_str());
      std::fflush(stdout);
    }
  }

  Result<RecordingGaps> finish() { return writer_.close(); }
  [[nodiscard]] bool told_to_quit() const noexcept { return quit_; }

 private:
  std::string answer(std::string_view line) {
    const auto request = parse_control_line(line, context_);
    if (!request) return error_line(request.error().text);
    switch (request->kind) {
      case ControlRequest::Kind::Stats:
        return status_json(relay_.status.get(), relay_.start());
      case ControlRequest::Kind::Quit:
        quit_ = true;
        return "{\"quit\":true}";
      case ControlRequest::Kind::Record:
        if (request->prefix.empty()) {
          const auto closed = writer_.close();
          return closed ? recording_end_line(*closed) : error_line(closed.error().text);
        }
        if (const auto opened = writer_.open(request->prefix); !opened) {
          return error_line(opened.error().text);
        }
        return "{\"recording\":true}";
      case ControlRequest::Kind::Change:
        break;
    }
    return send(*request, line);
  }

  std::string send(const ControlRequest& request, std::string_view line) {
    const TimePoint now = monotonic_now();
    const Change& asked = request.up ? request.change_up : request.change_down;
    const TimePoint at = request.now ? now : std::max(now, relay_.start() + asked.at);
    const auto hand_over = [&](Direction direction, const Change& change, Impairment& current) {
      if (!relay_.commands.try_enqueue({prepare(change), direction, at, std::string{line}})) {
        return false;
      }
      const bool law = change.kind == Change::Kind::Set || change.kind == Change::Kind::Ramp;
      if (law) current = change.impairment;
      return true;
    };
    const bool rebind = asked.kind == Change::Kind::Rebind;
    bool taken = true;
    if (request.up) taken = hand_over(Direction::Up, request.change_up, context_.up);
    if (request.down && !(rebind && request.up)) {
      taken = hand_over(Direction::Down, request.change_down, context_.down) && taken;
    }
    if (!taken) return error_line("too many changes wait for their time");
    return "{\"applied_at_s\":" + config::json_number(seconds(at - relay_.start())) + "}";
  }

  void log_applied() {
    RelayCommand spent;
    while (relay_.spent.try_dequeue(spent)) {
      std::printf("%.3f s, %s: %s\n",
                  seconds(spent.at - relay_.start()),
                  spent.direction == Direction::Up ? "up" : "down",
                  spent.words.c_str());
      std::fflush(stdout);
    }
  }

  Relay& relay_;
  const RelayProgramConfig& config_;
  ControlContext context_;
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
    return config::write_whole_file(config.report, relay_report(relay, run));
  };
  if (auto written = write_report(); !written) return written;
  Attendant attendant{relay, config};
  if (auto opened = attendant.open(); !opened) return opened;
  std::printf("listening on %s\n", relay.listening_on().to_string().c_str());
  std::printf("forwarding to %s\nup   %s\ndown %s\n",
              run.forward.to_string().c_str(),
              run.up.c_str(),
              run.down.c_str());
  std::fflush(stdout);
  {
    io::BackgroundLoop loop{"netem attendant", kPause, [&](TimePoint now) { attendant.work(now); }};
    const TimePoint until = monotonic_now() + config.duration;
    bool warned = false;
    while (!attendant.told_to_quit()) {
      const Duration left = until - monotonic_now();
      if (left <= Duration{} || !relay.serve(std::min(left, kSlice))) break;
      if (!relay.real_time() && !warned) {
        warned = true;
        std::fputs(
            "palp-netem: no right to SCHED_FIFO: releases may be late when the machine is busy\n",
            stderr);
      }
    }
    loop.stop();
  }
  const auto finished = attendant.finish();
  std::fputs(relay_summary(relay).c_str(), stdout);
  if (auto written = write_report(); !written) return written;
  return finished ? Result<void>{} : tl::unexpected<Error>(finished.error());
}

}  // namespace palp::netem
