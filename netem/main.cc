// palp-netem: impaired paths for datagrams between two UDP ports.
#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include <unistd.h>

#include "common/config/command_line.h"
#include "common/config/number.h"
#include "common/config/program_run.h"
#include "common/config/report.h"
#include "common/core/printable.h"
#include "common/core/random.h"
#include "common/io/net/datagram_socket.h"
#include "common/io/net/endpoint.h"
#include "common/io/process/diagnostics.h"
#include "common/io/process/hardening.h"
#include "common/io/process/stop_signals.h"
#include "netem/model/simulation.h"
#include "netem/presets_command.h"
#include "netem/relay/control_token.h"
#include "netem/relay/relay_program.h"
#include "netem/syntax/impairment_text.h"
#include "netem/syntax/presets.h"

namespace palp::netem {
namespace {

using io::monotonic_now;

using config::ExitCode;
using config::ExitStatus;

constexpr double kDurationMax = 1e6;  ///< [s]

/// The command line, as given; texts are empty where it says nothing.
struct Flags {
  std::optional<HostAndPort> listen;
  std::optional<HostAndPort> forward;
  std::string spec;
  std::string up;
  std::string down;
  std::string preset;
  std::string timeline;
  std::string mode{"exact"};
  std::optional<double> rtt_ms;
  std::optional<double> delay_ms;
  std::optional<double> jitter_ms;
  std::string loss;
  std::optional<std::uint64_t> seed;
  std::string record;
  std::string control;
  std::string control_token;
  std::string control_folder;
  std::string report;
  std::optional<double> status_s;
  double duration_s{};  ///< 0: until told to stop
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

struct Plans {
  PathPlan up;
  PathPlan down;
  std::optional<std::uint64_t> seed;
  std::string preset;  ///< of a timeline
};

ExitStatus bad_input(const std::string& sentence) {
  return {ExitCode::BadInput, "palp-netem: " + sentence};
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
                       {"--timeline", !flags.timeline.empty(), 4},
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
  // Words have the mode of the flag; the others say theirs, or are laws of mode exact.
  if (flags.mode != "exact" && first != nullptr && first->way > 1) {
    return clash("--mode " + flags.mode, first->flag);
  }
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

Result<Plans> plain_impairments(const Flags& flags) {
  const auto loss = loss_flag(flags.loss);
  if (!loss) return tl::unexpected<Error>(loss.error());
  const Duration jitter = from_seconds(flags.jitter_ms.value_or(0) * 1e-3);
  const auto impairment =
      flags.rtt_ms
          ? impairment_from_rtt(from_seconds(*flags.rtt_ms * 1e-3), jitter, *loss)
          : impairment_from_delay(from_seconds(flags.delay_ms.value_or(0) * 1e-3), jitter, *loss);
  if (!impairment) return tl::unexpected<Error>(impairment.error());
  return Plans{{.impairment = *impairment}, {.impairment = *impairment}, {}, {}};
}

/// The timeline's file; a name of a preset in it is understood.
Result<Timeline> load_timeline(const std::string& path) {
  const auto text = read_data_file(path);
  if (!text) return fail("--timeline", text.error());
  return parse_timeline(path, *text, [](const std::string& name) { return find_preset(name); });
}

Result<Plans> asked_plans(const Flags& flags) {
  if (const auto one = one_way_only(flags); !one) return tl::unexpected<Error>(one.error());
  if (!flags.preset.empty()) {
    auto preset = find_preset(flags.preset);
    if (!preset) return tl::unexpected<Error>(preset.error());
    return Plans{preset->up, preset->down, preset->seed, flags.preset};
  }
  if (!flags.timeline.empty()) {
    auto timeline = load_timeline(flags.timeline);
    if (!timeline) return tl::unexpected<Error>(timeline.error());
    return Plans{timeline->up, timeline->down, timeline->seed, timeline->preset};
  }
  if (flags.rtt_ms || flags.delay_ms || flags.jitter_ms || !flags.loss.empty()) {
    return plain_impairments(flags);
  }
  const Mode mode = flags.mode == "exact" ? Mode::Exact : Mode::Netem61;
  const auto up = parse_impairment(flags.spec.empty() ? flags.up : flags.spec, mode);
  if (!up) return fail((flags.spec.empty() ? "--up: " : "--spec: ") + up.error().text);
  const auto down = parse_impairment(flags.spec.empty() ? flags.down : flags.spec, mode);
  if (!down) return fail("--down: " + down.error().text);
  return Plans{{.impairment = *up}, {.impairment = *down}, {}, {}};
}

ExitStatus serve(const Flags& flags) {
  RelayProgramConfig config;
  const auto listen = io::resolve(*flags.listen);
  if (!listen) return bad_input("--listen: " + listen.error().text);
  config.listen = *listen;
  const auto forward = io::resolve(*flags.forward);
  if (!forward) return bad_input("--forward: " + forward.error().text);
  config.forward = *forward;
  const auto asked = asked_plans(flags);
  if (!asked) return config::refusal("palp-netem", asked.error());
  config.up = asked->up;
  config.down = asked->down;
  config.preset = flags.preset.empty() ? asked->preset : flags.preset;
  config.seed = flags.seed ? *flags.seed : asked->seed.value_or(1);
  config.record = flags.record;
  config.control = flags.control;
  config.control_folder = flags.control_folder;
  if (!flags.control_token.empty()) {
    const auto token = read_or_make_token(flags.control_token);
    if (!token)
      return config::refusal("palp-netem",
                             {"--control-token: " + token.error().text, token.error().unreachable});
    config.control_token = *token;
  }
  config.report = flags.report;
  config.duration = from_seconds(flags.duration_s > 0 ? flags.duration_s : kDurationMax);
  config.status_every =
      from_seconds(flags.status_s.value_or(::isatty(STDOUT_FILENO) != 0 ? 1.0 : 0.0));
  config.stop_descriptor = io::open_stop_signals();
  if (const auto served = run_relay(config); !served) {
    return config::refusal("palp-netem", served.error());
  }
  return {ExitCode::Done, ""};
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
  relay.text("--timeline", flags.timeline, "FILE", "events over time, message Timeline as text");
  relay.choice(
      "--mode", flags.mode, {"exact", "netem-6.1"}, "what the numbers say, or what Linux does");
  relay.number("--rtt-ms", flags.rtt_ms, milliseconds, "round trip, half of it each way");
  relay.number("--delay-ms", flags.delay_ms, milliseconds, "delay of each way");
  relay.number(
      "--jitter-ms", flags.jitter_ms, milliseconds, "its standard deviation, each way; reorders");
  relay.text("--loss", flags.loss, "P", "loss of each way, a fraction or 5%");
  relay.whole("--seed",
              flags.seed,
              {.min = 0, .max = std::numeric_limits<std::uint64_t>::max()},
              "of everything random");
  relay.text(
      "--record", flags.record, "PREFIX", "to PREFIX-up.csv, PREFIX-down.csv, PREFIX.pcapng");
  relay.text("--control",
             flags.control,
             "ADDRESS",
             "events as JSON lines: unix:PATH, for this user only, or 127.0.0.1:PORT with a token");
  relay.text("--control-token",
             flags.control_token,
             "FILE",
             "what callers of a port show first; made where there is none");
  relay.text("--control-folder",
             flags.control_folder,
             "FOLDER",
             "whose files trace, replay and record of live control may name; otherwise none");
  relay.report(flags.report, "palp.relay/1");
  relay.number("--status-s",
               flags.status_s,
               {.min = 0, .max = kDurationMax, .unit = "s"},
               "a line so often; 0: none (default: 1 on a terminal)");
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

ExitStatus run_simulate(const SimulateFlags& flags) {
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
  line.output("--csv", flags.csv, "a line for each datagram and copy");
  line.footer(std::string{impairment_help()});
}

int run(int argc, char** argv) {
  // A recording holds what two sites say to each other.
  if (const auto refused = io::harden_process()) io::warn(*refused);
  Flags flags;
  config::CommandLine line{"palp-netem", "An impaired path for datagrams."};
  declare_relay(line.verb("relay", "forward datagrams between two UDP ports"), flags);
  const PresetsCommand presets{line};
  SimulateFlags simulation;
  declare_simulate(line.verb("simulate", "decide about datagrams without any socket"), simulation);
  return config::run_program(line, argc, argv, [&] {
    if (line.chosen_verb() == "simulate") return run_simulate(simulation);
    return line.chosen_verb() == "relay" ? serve(flags) : presets.run();
  });
}

}  // namespace
}  // namespace palp::netem

int main(int argc, char** argv) { return palp::netem::run(argc, argv); }
