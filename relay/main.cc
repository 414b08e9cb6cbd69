// palp-relay: lets two sites meet that can both call but not be called.
#include <array>
#include <cstdio>
#include <optional>
#include <string>

#include <poll.h>

#include "common/config/command_line.h"
#include "common/config/program_run.h"
#include "common/config/report.h"
#include "common/io/net/datagram_socket.h"
#include "common/io/net/endpoint.h"
#include "common/io/process/descriptor.h"
#include "common/io/process/hardening.h"
#include "common/io/process/stop_signals.h"
#include "relay/relay_report.h"
#include "relay/rooms.h"

namespace palp::relay {
namespace {

using config::ExitCode;
using config::ExitStatus;

struct Flags {
  std::optional<HostAndPort> listen;
  std::string report;
  double status_s{};
};

/// All that waits, one by one: what came first leaves first, and nothing waits for a batch.
void serve_once(io::DatagramSocket& socket, Rooms& rooms) {
  const auto datagrams = socket.receive();
  const TimePoint now = io::monotonic_now();
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    const auto out = rooms.hear(datagrams[i].bytes, socket.sender_of(i), now);
    if (!out) continue;
    const io::OutgoingDatagram one{.bytes = out->bytes, .tos = datagrams[i].tos};
    (void)socket.send({&one, 1}, &out->to);
  }
}

ExitStatus serve(const Flags& flags) {
  const auto listen = io::resolve(*flags.listen);
  if (!listen) return {ExitCode::BadInput, "palp-relay: --listen: " + listen.error().text};
  const io::Descriptor stop{io::open_stop_signals()};
  io::DatagramSocket socket = io::DatagramSocket::bound(*listen);
  Rooms rooms;
  std::printf("listening on %s\n", socket.local().to_string().c_str());
  std::fflush(stdout);
  const TimePoint begin = io::monotonic_now();
  TimePoint told_at = begin;
  const Duration every = from_seconds(flags.status_s);
  std::array<pollfd, 2> watched{{{socket.descriptor(), POLLIN, 0}, {stop.number(), POLLIN, 0}}};
  while ((watched[1].revents & POLLIN) == 0) {
    constexpr int kLookMs = 500;  // [ms], between two looks at the time
    if (::poll(watched.data(), watched.size(), kLookMs) < 0) continue;
    if (watched[0].revents != 0) serve_once(socket, rooms);
    const TimePoint now = io::monotonic_now();
    if (every > Duration{} && now - told_at >= every) {
      told_at = now;
      std::printf("%s\n", status_line(rooms).c_str());
      std::fflush(stdout);
    }
  }
  if (!flags.report.empty()) {
    const std::string text = to_json(rooms.counts(), io::monotonic_now() - begin);
    if (const auto written = config::write_whole_file(flags.report, text); !written) {
      return config::refusal("palp-relay", written.error());
    }
  }
  return {ExitCode::Done, status_line(rooms)};
}

int run(int argc, char** argv) {
  if (const auto refused = io::harden_process()) std::fprintf(stderr, "%s\n", refused->c_str());
  Flags flags;
  config::CommandLine line{"palp-relay",
                           "Forwards sealed datagrams between two sites that cannot be called."};
  line.address("--listen", flags.listen, 0, "where both sites send to; port 0: any");
  line.required();
  line.number("--status-s",
              flags.status_s,
              {.min = 0, .max = 86'400, .unit = "s"},
              "a line so often; 0: none");
  line.report(flags.report, "palp.rooms/1");
  return config::run_program(line, argc, argv, [&] { return serve(flags); });
}

}  // namespace
}  // namespace palp::relay

int main(int argc, char** argv) { return palp::relay::run(argc, argv); }
