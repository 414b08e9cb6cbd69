// palp-netem: impaired paths for datagrams between two UDP ports.
#include <csignal>
#include <cstdio>
#include <exception>
#include <limits>
#include <optional>
#include <string>

#include <sys/signalfd.h>
#include <unistd.h>

#include "common/config/command_line.h"
#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/printable.h"
#include "common/core/random.h"
#include "common/io/endpoint.h"
#include "netem/presets.h"
#include "netem/relay.h"
#include "netem/relay_report.h"
#include "netem/simulation.h"

namespace palp::netem {
namespace {

using config::Ending;
using config::ExitCode;

/// Below the 80 of a site's control loop: the path must not delay the sites themselves.
constexpr int kPriority = 60;
constexpr double kDurationMax = 1e6;  ///< [s]

/// The command line, as given; texts are empty where it says nothing.
struct Flags {
  std::optional<HostAndPort> listen;
  std::optional<HostAndPort> forward;
  std::string spec;
  std::string up;
  std::string down;
  std::string preset;
  std::optional<double> rtt_ms;
  std::optional<double> delay_ms;
  std::optional<double> jitter_ms;
  std::string loss;
  std::uint64_t seed{1};
  std::string report;
  double duration_s{};  ///< 0: until told to stop
  std::string shown;    ///< presets NAME
};

/// The command line of `simulate`.
struct SimulateFlags {
  std::string spec;
  std::string mode{"exact"};
  std::string direction{"up"};
  std::uint64_t packets{};
  double interval_us{1000};
  std::uint64_t burst{1};
  std::uint64_t length{142};  ///< [bytes]
  std::uint64_t seed{1};
  std::string csv;
};

struct Impairments {
  Impairment up;
  Impairment down;
};

Ending bad_input(const std::string& sentence) {
  return {ExitCode::BadInput, "palp-netem: " + sentence};
}
Ending cannot_open(const std::string& sentence) {
  return {ExitCode::CannotOpen, "palp-netem: " + sentence};
}

/// The ways to name an impairment exclude each other.
Result<void> one_way_only(const Flags& flags) {
  struct Given {
    const char* flag;
    bool given;
    int way;
  };
  const Given all[] = {{"--spec", !flags.spec.empty(), 0},
                       {"--up", !flags.up.empty(), 1},
                       {"--down", !flags.down.empty(), 1},
                       {"--preset", !flags.preset.empty(), 2},
                       {"--rtt-ms", flags.rtt_ms.has_value(), 3},
                       {"--delay-ms", flags.delay_ms.has_value(), 3},
                       {"--jitter-ms", flags.jitter_ms.has_value(), 3},
                       {"--loss", !flags.loss.empty(), 3}};
  const auto clash = [](const std::string& one, const std::string& other) {
    return fail(one + " and " + other + " exclude each other");
  };
  const Given* first = nullptr;
  for (const Given& one : all) {
    if (!one.given) continue;
    if (first != nullptr && first->way != one.way) return clash(first->flag, one.flag);
    first = &one;
  }
  if (flags.rtt_ms && flags.delay_ms) return clash("--rtt-ms", "--delay-ms");
  return {};
}

/// `0.05`, a fraction as everywhere in flags and reports, or `5%`.
Result<double> loss_flag(const std::string& text) {
  if (text.empty()) return 0.0;
  const auto loss = config::parse_share(text);
  if (!loss || !(*loss >= 0 && *loss <= 1)) {
    return fail("--loss is \"" + printable(text) +
                "\", expected a fraction from 0 to 1, or a share as 5%");
  }
  return *loss;
}

Result<Impairments> plain_impairments(const Flags& flags) {
  const auto loss = loss_flag(flags.loss);
  if (!loss) return tl::unexpected<Error>(loss.error());
  const Duration jitter = from_seconds(flags.jitter_ms.value_or(0) * 1e-3);
  const auto impairment =
      flags.rtt_ms
          ? impairment_from_rtt(from_seconds(*flags.rtt_ms * 1e-3), jitter, *loss)
          : impairment_from_delay(from_seconds(flags.delay_ms.value_or(0) * 1e-3), jitter, *loss);
  if (!impairment) return tl::unexpected<Error>(impairment.error());
  return Impairments{*impairment, *impairment};
}

Result<Impairments> asked_impairments(const Flags& flags) {
  if (const auto one = one_way_only(flags); !one) return tl::unexpected<Error>(one.error());
  if (!flags.preset.empty()) {
    auto preset = find_preset(flags.preset);
    if (!preset) return tl::unexpected<Error>(preset.error());
    return Impairments{preset->up, preset->down};
  }
  if (flags.rtt_ms || flags.delay_ms || flags.jitter_ms || !flags.loss.empty()) {
    return plain_impairments(flags);
  }
  const auto up = parse_impairment(flags.spec.empty() ? flags.up : flags.spec);
  if (!up) return fail((flags.spec.empty() ? "--up: " : "--spec: ") + up.error().text);
  const auto down = parse_impairment(flags.spec.empty() ? flags.down : flags.spec);
  if (!down) return fail("--down: " + down.error().text);
  return Impairments{*up, *down};
}

/// A descriptor that becomes readable at SIGINT or SIGTERM.
int stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // A shell starts background jobs with SIGINT ignored; blocked signals with a handler are kept.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  ::sigprocmask(SIG_BLOCK, &signals, nullptr);
  return ::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// Serves until told to stop; the report is written at once as well: a path that cannot be written
/// is known before the session.
Ending serve(Relay& relay, const Flags& flags, RelayRun run) {
  const TimePoint began = monotonic_now();
  const auto write_report = [&]() -> Result<void> {
    if (flags.report.empty()) return {};
    run.duration = monotonic_now() - began;
    return config::write_whole_file(flags.report, relay_report(relay, run));
  };
  if (const auto written = write_report(); !written) return cannot_open(written.error().text);
  if (!relay.real_time()) {
    std::fputs(
        "palp-netem: no right to SCHED_FIFO: releases may be late when the machine is busy\n",
        stderr);
  }
  std::printf("listening on %s\n", relay.listening_on().to_string().c_str());
  std::printf("forwarding to %s\nup   %s\ndown %s\n",
              run.forward.to_string().c_str(),
              to_string(run.up).c_str(),
              to_string(run.down).c_str());
  std::fflush(stdout);
  relay.serve(from_seconds(flags.duration_s > 0 ? flags.duration_s : kDurationMax));
  std::fputs(relay_summary(relay).c_str(), stdout);
  if (const auto written = write_report(); !written) return cannot_open(written.error().text);
  return {ExitCode::Done, ""};
}

Ending run_relay(const Flags& flags) {
  const auto listen = io::resolve(*flags.listen);
  if (!listen) return bad_input("--listen: " + listen.error().text);
  const auto forward = io::resolve(*flags.forward);
  if (!forward) return bad_input("--forward: " + forward.error().text);
  const auto asked = asked_impairments(flags);
  if (!asked) return bad_input(asked.error().text);
  Relay relay{{.listen = *listen,
               .forward = *forward,
               .up = asked->up,
               .down = asked->down,
               .seed = flags.seed,
               .priority = kPriority,
               .stop_descriptor = stop_signals()}};
  return serve(relay,
               flags,
               {.preset = flags.preset,
                .up = asked->up,
                .down = asked->down,
                .seed = flags.seed,
                .forward = *forward,
                .duration = {}});
}

std::string description(const Preset& preset) {
  std::string text = preset.name + ": " + preset.summary + '\n';
  if (preset.up == preset.down) {
    text += "  both ways  " + to_string(preset.up) + '\n';
  } else {
    text += "  up         " + to_string(preset.up) + '\n';
    text += "  down       " + to_string(preset.down) + '\n';
  }
  return text + "  source     " + preset.source + '\n';
}

Ending show_presets(const std::string& name) {
  if (!name.empty()) {
    const auto preset = find_preset(name);
    if (!preset) return bad_input(preset.error().text);
    return {ExitCode::Done, description(*preset)};
  }
  std::string text;
  for (const Preset& preset : presets()) text += description(preset);
  return {ExitCode::Done, text};
}

void declare_relay(config::CommandLine& relay, Flags& flags) {
  const config::NumberRange milliseconds{.min = 0, .max = 1e9, .unit = "ms"};
  relay.address("--listen", flags.listen, 0, "where the surgeon sends to; port 0: any");
  relay.required();
  relay.address("--forward", flags.forward, 1, "the patient");
  relay.required();
  relay.text("--spec", flags.spec, "SPEC", "impairment of both directions");
  relay.text("--up", flags.up, "SPEC", "impairment from surgeon to patient");
  relay.text("--down", flags.down, "SPEC", "impairment from patient to surgeon");
  relay.text("--preset", flags.preset, "NAME", "a named link, see presets");
  relay.number("--rtt-ms", flags.rtt_ms, milliseconds, "round trip, half of it each way");
  relay.number("--delay-ms", flags.delay_ms, milliseconds, "delay of each way");
  relay.number(
      "--jitter-ms", flags.jitter_ms, milliseconds, "its standard deviation, each way; reorders");
  relay.text("--loss", flags.loss, "P", "loss of each way, a fraction or 5%");
  relay.whole("--seed",
              flags.seed,
              {.min = 0, .max = std::numeric_limits<std::uint64_t>::max()},
              "of everything random");
  relay.text("--report", flags.report, "FILE", "JSON report, written when the relay ends");
  relay.number("--duration-s",
               flags.duration_s,
               {.min = 0, .max = kDurationMax, .unit = "s"},
               "end after this time; 0: never");
  relay.footer(std::string{impairment_help()});
}

/// How long as many draws of the plain generator take, for comparison.
Duration plain_draws(std::uint64_t count, std::uint64_t seed) {
  const TimePoint begin = monotonic_now();
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < count; ++i) sum ^= random_bits(seed, 0, i);
  const TimePoint end = monotonic_now();
  // The sum is used, so that the draws are made.
  return end - begin + Duration{sum == 0 ? 1 : 0};
}

Ending run_simulate(const SimulateFlags& flags) {
  const Mode mode = flags.mode == "exact" ? Mode::Exact : Mode::Netem61;
  auto impairment = parse_impairment(flags.spec, mode);
  if (!impairment) return {ExitCode::BadInput, "palp-netem: --spec: " + impairment.error().text};
  const SimulationConfig simulation{
      .plan = {.impairment = *std::move(impairment)},
      .packets = flags.packets,
      .interval = from_seconds(flags.interval_us * 1e-6),
      .burst = flags.burst,
      .frame_length = flags.length,
      .direction = flags.direction == "up" ? Direction::Up : Direction::Down,
      .seed = flags.seed};
  std::string csv{flags.csv.empty() ? "" : std::string{kRecordingHeader} + '\n'};
  DecisionOrder::Sink each;
  if (!flags.csv.empty()) {
    each = [&csv](const Decision& decision) {
      append_recording_line(csv, decision, TimePoint{});
      csv += '\n';
    };
  }
  const TimePoint begin = monotonic_now();
  const SimulationResult result = simulate(simulation, each);
  const Duration taken = monotonic_now() - begin;
  if (!flags.csv.empty()) {
    if (const auto written = config::write_whole_file(flags.csv, csv); !written) {
      return {ExitCode::CannotOpen, "palp-netem: " + written.error().text};
    }
  }
  char timing[160];
  std::snprintf(timing,
                sizeof timing,
                "%.1f ms for the decisions; as many plain draws of the generator take %.1f ms\n",
                seconds(taken) * 1e3,
                seconds(plain_draws(flags.packets, flags.seed)) * 1e3);
  return {ExitCode::Done, to_string(result) + timing};
}

void declare_simulate(config::CommandLine& line, SimulateFlags& flags) {
  /// Frames are at least the headers and at most what IPv4 can carry in one datagram.
  constexpr std::uint64_t kLengthMax = 65'535 + kEthernetHeader;
  constexpr double kIntervalMax = 1e9;  // [us]
  line.text("--spec", flags.spec, "SPEC", "impairment of the direction");
  line.required();
  line.whole("--packets", flags.packets, {.min = 1, .max = 1'000'000'000}, "how many are sent");
  line.required();
  line.number("--interval-us",
              flags.interval_us,
              {.min = 0, .max = kIntervalMax, .unit = "us"},
              "from one to the next");
  line.whole("--burst", flags.burst, {.min = 1, .max = 1'000'000}, "so many with one time stamp");
  line.whole("--length-bytes",
             flags.length,
             {.min = kFrameHeaders, .max = kLengthMax},
             "on the link as a qdisc counts them: UDP payload + 42");
  line.choice("--direction", flags.direction, {"up", "down"}, "each has draws of its own");
  line.whole("--seed",
             flags.seed,
             {.min = 0, .max = std::numeric_limits<std::uint64_t>::max()},
             "of everything random");
  line.choice(
      "--mode", flags.mode, {"exact", "netem-6.1"}, "what the numbers say, or what Linux does");
  line.text("--csv", flags.csv, "FILE", "a line for each datagram and copy");
  line.footer(std::string{impairment_help()});
}

int run(int argc, char** argv) {
  Flags flags;
  config::CommandLine line{"palp-netem", "An impaired path for datagrams."};
  declare_relay(line.verb("relay", "forward datagrams between two UDP ports"), flags);
  config::CommandLine& shown = line.verb("presets", "the named links and where they come from");
  shown.argument("NAME", flags.shown, "only this one");
  SimulateFlags simulation;
  declare_simulate(line.verb("simulate", "decide about datagrams without any socket"), simulation);
  if (const auto ending = line.parse(argc, argv)) return leave(*ending);
  if (line.chosen_verb() == "simulate") return leave(run_simulate(simulation));
  return leave(line.chosen_verb() == "relay" ? run_relay(flags) : show_presets(flags.shown));
}

}  // namespace
}  // namespace palp::netem

int main(int argc, char** argv) {
  try {
    return palp::netem::run(argc, argv);
  } catch (const std::exception& error) {
    return leave(palp::netem::cannot_open(error.what()));
  }
}
