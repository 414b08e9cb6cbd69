#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <variant>

#include <CLI/CLI.hpp>
#include <sys/signalfd.h>
#include <unistd.h>

#include "netem/endpoint.h"
#include "netem/presets.h"
#include "netem/relay.h"
#include "netem/relay_report.h"

/// palp-netem: impaired paths for datagrams between two UDP ports.
namespace palp::netem {
namespace {

constexpr int kDone = 0;
constexpr int kBadInput = 2;
constexpr int kCannotStart = 3;
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

/// The command line, as given.
struct Flags {
  std::string listen;
  std::string forward;
  std::string spec;
  std::string up;
  std::string down;
  std::string preset;
  double rtt_ms{};
  double delay_ms{};
  double jitter_ms{};
  std::string loss{"0"};
  bool rtt_given{};
  bool plain_given{};  ///< any of --rtt-ms, --delay-ms, --jitter-ms, --loss
  std::uint64_t seed{1};
  std::string report;
  double duration_s{};  ///< 0: until told to stop
  bool relay{};         ///< the verb; else presets
  std::string shown;    ///< presets NAME
};

struct Impairments {
  Impairment up;
  Impairment down;
};

Result<Duration> milliseconds_flag(const char* flag, double value) {
  if (!(value >= 0 && value <= 1e9)) {
    return fail(std::string{flag} + " is " + std::to_string(value) + ", expected 0 to 1e9");
  }
  return from_seconds(value * 1e-3);
}

/// `0.05`, a fraction as everywhere in flags and reports, or `5%`.
Result<double> loss_flag(const std::string& text) {
  if (text.ends_with('%')) {
    const auto impairment = parse_impairment("loss " + text);
    if (!impairment) return fail("--loss is '" + text + "', expected 0% to 100%");
    return impairment->loss;
  }
  double loss = 0;
  if (!CLI::detail::lexical_cast(text, loss) || !(loss >= 0 && loss <= 1)) {
    return fail("--loss is '" + text + "', expected a fraction from 0 to 1, or a share as 5%");
  }
  return loss;
}

Result<Impairments> plain_impairments(const Flags& flags) {
  const auto delay = flags.rtt_given ? milliseconds_flag("--rtt-ms", flags.rtt_ms)
                                     : milliseconds_flag("--delay-ms", flags.delay_ms);
  if (!delay) return tl::unexpected<Error>(delay.error());
  const auto jitter = milliseconds_flag("--jitter-ms", flags.jitter_ms);
  if (!jitter) return tl::unexpected<Error>(jitter.error());
  const auto loss = loss_flag(flags.loss);
  if (!loss) return tl::unexpected<Error>(loss.error());
  const auto impairment = flags.rtt_given ? impairment_from_rtt(*delay, *jitter, *loss)
                                          : impairment_from_delay(*delay, *jitter, *loss);
  if (!impairment) return tl::unexpected<Error>(impairment.error());
  return Impairments{*impairment, *impairment};
}

Result<Impairments> asked_impairments(const Flags& flags) {
  if (!flags.preset.empty()) {
    auto preset = find_preset(flags.preset);
    if (!preset) return tl::unexpected<Error>(preset.error());
    return Impairments{preset->up, preset->down};
  }
  if (flags.plain_given) return plain_impairments(flags);
  const auto up = parse_impairment(flags.spec.empty() ? flags.up : flags.spec);
  if (!up) return fail((flags.spec.empty() ? "--up: " : "--spec: ") + up.error().text);
  const auto down = parse_impairment(flags.spec.empty() ? flags.down : flags.spec);
  if (!down) return fail("--down: " + down.error().text);
  return Impairments{*up, *down};
}

int complain(const std::string& sentence, int code) {
  std::fprintf(stderr, "palp-netem: %s\n", sentence.c_str());
  return code;
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

int run_relay(const Flags& flags) {
  const auto listen = parse_endpoint(flags.listen);
  if (!listen) return complain("--listen: " + listen.error().text, kBadInput);
  const auto forward = parse_endpoint(flags.forward);
  if (!forward) return complain("--forward: " + forward.error().text, kBadInput);
  if (forward->port == 0)
    return complain("--forward: the port is 0, expected 1 to 65535", kBadInput);
  const auto asked = asked_impairments(flags);
  if (!asked) return complain(asked.error().text, kBadInput);
  if (!(flags.duration_s >= 0 && flags.duration_s <= kDurationMax)) {
    return complain("--duration-s is out of range, expected 0 to 1000000", kBadInput);
  }

  Relay relay{{.listen = *listen,
               .forward = *forward,
               .up = asked->up,
               .down = asked->down,
               .seed = flags.seed,
               .priority = kPriority,
               .stop_descriptor = stop_signals()}};
  const TimePoint began = monotonic_now();
  const auto write_report = [&]() -> bool {
    if (flags.report.empty()) return true;
    const RelayRun run{.preset = flags.preset,
                       .up = asked->up,
                       .down = asked->down,
                       .seed = flags.seed,
                       .forward = *forward,
                       .duration = monotonic_now() - began};
    const auto written = write_whole(flags.report, relay_report(relay, run));
    if (!written) complain(written.error().text, kCannotStart);
    return written.has_value();
  };
  // Written at once as well: a path that cannot be written is known before the session.
  if (!write_report()) return kCannotStart;
  if (!relay.real_time()) {
    complain("no right to SCHED_FIFO: releases may be late when the machine is busy", 0);
  }
  std::printf("listening on %s\n", to_string(relay.listening_on()).c_str());
  std::printf("forwarding to %s\nup   %s\ndown %s\n",
              to_string(*forward).c_str(),
              to_string(asked->up).c_str(),
              to_string(asked->down).c_str());
  std::fflush(stdout);
  relay.serve(from_seconds(flags.duration_s > 0 ? flags.duration_s : kDurationMax));
  std::fputs(relay_summary(relay).c_str(), stdout);
  return write_report() ? kDone : kCannotStart;
}

int show_presets(const std::string& name) {
  if (!name.empty()) {
    const auto preset = find_preset(name);
    if (!preset) return complain(preset.error().text, kBadInput);
  }
  for (const Preset& preset : presets()) {
    if (!name.empty() && preset.name != name) continue;
    std::printf("%s: %s\n", preset.name.c_str(), preset.summary.c_str());
    if (preset.up == preset.down) {
      std::printf("  both ways  %s\n", to_string(preset.up).c_str());
    } else {
      std::printf("  up         %s\n  down       %s\n",
                  to_string(preset.up).c_str(),
                  to_string(preset.down).c_str());
    }
    std::printf("  source     %s\n", preset.source.c_str());
  }
  return kDone;
}

/// The flags, or the exit code when there is nothing to run.
std::variant<Flags, int> read_flags(int argc, char** argv) {
  Flags flags;
  CLI::App app{"palp-netem: an impaired path for datagrams"};
  app.require_subcommand(1);
  CLI::App* relay = app.add_subcommand("relay", "forward datagrams between two UDP ports");
  relay->footer(kWords);
  relay->add_option("--listen", flags.listen, "ADDRESS:PORT the surgeon sends to; port 0: any")
      ->required();
  relay->add_option("--forward", flags.forward, "ADDRESS:PORT of the patient")->required();
  auto* spec = relay->add_option("--spec", flags.spec, "impairment of both directions");
  auto* up = relay->add_option("--up", flags.up, "impairment from surgeon to patient");
  auto* down = relay->add_option("--down", flags.down, "impairment from patient to surgeon");
  auto* preset = relay->add_option("--preset", flags.preset, "a named link, see presets");
  auto* rtt = relay->add_option("--rtt-ms", flags.rtt_ms, "round trip [ms], half of it each way");
  auto* delay = relay->add_option("--delay-ms", flags.delay_ms, "delay of each way [ms]");
  auto* jitter = relay->add_option(
      "--jitter-ms", flags.jitter_ms, "its standard deviation, each way [ms]; reorders");
  auto* loss = relay->add_option("--loss", flags.loss, "loss of each way, a fraction or 5%");
  relay->add_option("--seed", flags.seed, "of everything random")->capture_default_str();
  relay->add_option("--report", flags.report, "JSON report, written when the relay ends");
  relay->add_option("--duration-s", flags.duration_s, "end after this time [s]; 0: never");
  rtt->excludes(delay);
  for (CLI::Option* plain : {rtt, delay, jitter, loss}) {
    plain->excludes(spec)->excludes(up)->excludes(down)->excludes(preset);
  }
  preset->excludes(spec)->excludes(up)->excludes(down);
  spec->excludes(up)->excludes(down);
  CLI::App* shown = app.add_subcommand("presets", "the named links and where they come from");
  shown->add_option("name", flags.shown, "only this one");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  flags.relay = relay->parsed();
  flags.rtt_given = rtt->count() > 0;
  flags.plain_given = rtt->count() + delay->count() + jitter->count() + loss->count() > 0;
  return flags;
}

int run(int argc, char** argv) {
  const auto read = read_flags(argc, argv);
  if (const int* code = std::get_if<int>(&read)) return *code;
  const Flags& flags = std::get<Flags>(read);
  return flags.relay ? run_relay(flags) : show_presets(flags.shown);
}

}  // namespace
}  // namespace palp::netem

int main(int argc, char** argv) {
  try {
    return palp::netem::run(argc, argv);
  } catch (const std::exception& error) {
    return palp::netem::complain(error.what(), palp::netem::kCannotStart);
  }
}
