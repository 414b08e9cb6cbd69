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
#include "common/io/endpoint.h"
#include "netem/presets.h"
#include "netem/relay.h"
#include "netem/relay_report.h"

namespace palp::netem {
namespace {

using config::Ending;
using config::ExitCode;

/// Below the 80 of a site's control loop: the path must not delay the sites themselves.
constexpr int kPriority = 60;
constexpr double kDurationMax = 1e6;  ///< [s]

constexpr const char* kWords = R"(Impairments (SPEC), words in any order:
  delay MEAN [JITTER [CORRELATION]] [distribution uniform|normal] [floor SHARE]
        [correlation-time TIME]
  loss [random] SHARE
  loss burst RATE LENGTH                        as: loss burst 0.2/s 200ms
  loss gilbert-time GOOD BAD [LOSS_IN_BAD [LOSS_IN_GOOD]]
  duplicate SHARE
  blackout FROM LENGTH                          from the start; may be repeated
  order keep|free                               keep: nothing overtakes (default)
Times need their unit (us, ms, s), shares their %. Delays are one way.)";

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
  relay.footer(kWords);
}

int run(int argc, char** argv) {
  Flags flags;
  config::CommandLine line{"palp-netem", "An impaired path for datagrams."};
  declare_relay(line.verb("relay", "forward datagrams between two UDP ports"), flags);
  config::CommandLine& shown = line.verb("presets", "the named links and where they come from");
  shown.argument("NAME", flags.shown, "only this one");
  if (const auto ending = line.parse(argc, argv)) return leave(*ending);
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
