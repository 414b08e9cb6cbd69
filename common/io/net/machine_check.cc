#include "common/io/net/machine_check.h"

#include <fstream>

#include <sched.h>
#include <sys/socket.h>

#include "common/core/number_text.h"
#include "common/io/net/udp_socket.h"
#include "common/io/process/descriptor.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

/// A tick that begins this late is still well inside its period.
constexpr double kLatenessShare = 0.1;  // [-] of the period
/// More than this share of periods without a tick is felt.
constexpr double kMissedShare = 1e-3;  // [-]
/// rt, io, record and, at the patient's, the estimator.
constexpr int kProcessors = 2;

std::string first_word_of(const char* path) {
  std::string word;
  std::ifstream{path} >> word;
  return word;
}

int usable_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

/// What a socket that asks for `bytes` gets; the kernel tells twice as much as it holds.
int granted_buffer(int bytes) {
  const Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  ask_receive_buffer(socket.number(), bytes);
  int given = 0;
  socklen_t size = sizeof given;
  if (::getsockopt(socket.number(), SOL_SOCKET, SO_RCVBUF, &given, &size) != 0) return 0;
  return given / 2;
}

double microseconds_of(Duration span) { return seconds(span) * 1e6; }

MachineFinding scheduling(const RealtimeGrant& grant) {
  return {"scheduler rights",
          grant.scheduling,
          grant.priority > 0,
          grant.priority > 0 ? ""
                             : "give the user rtprio 80 in /etc/security/limits.d, or the program "
                               "CAP_SYS_NICE"};
}

MachineFinding memory(const RealtimeGrant& grant) {
  return {"memory lock",
          grant.memory,
          grant.memory_locked,
          grant.memory_locked
              ? ""
              : "give the user memlock unlimited in /etc/security/limits.d, or the program "
                "CAP_IPC_LOCK"};
}

MachineFinding timer(const LoopStats& loop, Duration period) {
  const double all = static_cast<double>(loop.ticks + loop.missed);
  const double missed = all > 0 ? static_cast<double>(loop.missed) / all : 1;
  const bool good = loop.ticks > 0 && missed <= kMissedShare &&
                    microseconds_of(loop.lateness_p99) <= kLatenessShare * microseconds_of(period);
  return {"timer lateness",
          number_text("99 % of the ticks within ", microseconds_of(loop.lateness_p99), 0, " us") +
              number_text(", the worst ", microseconds_of(loop.lateness_max), 0, " us late") +
              number_text(", ", missed * 1e3, 1, " of 1,000 missed"),
          good,
          good ? "" : "stop what else runs here, or give the site a machine of its own"};
}

MachineFinding clock_of(const std::string& source) {
  const bool slow = source == "hpet" || source == "acpi_pm" || source == "jiffies";
  return {"clock",
          source.empty() ? "the kernel does not say which" : source,
          !slow,
          slow ? "boot with clocksource=tsc: each look at this clock costs a microsecond" : ""};
}

MachineFinding governor_of(const std::string& governor) {
  const bool saves = !governor.empty() && governor != "performance";
  return {
      "processor frequency",
      governor.empty() ? "not governed here (a virtual machine, or fixed)" : governor,
      !saves,
      saves ? "cpupower frequency-set -g performance: waking up a slowed core takes longer" : ""};
}

MachineFinding processors_of(int processors) {
  const bool good = processors >= kProcessors;
  return {"processors",
          std::to_string(processors) + " usable",
          good,
          good ? "" : "two at least: one for the control loop, one for all else"};
}

MachineFinding buffer_of(int given, int wanted) {
  const bool good = given >= wanted;
  return {"socket buffer",
          number_text("", given / 1024.0, 0, " kB"),
          good,
          good ? "" : "sysctl -w net.core.rmem_max=" + std::to_string(wanted)};
}

}  // namespace

MachineFacts read_machine(const LoopConfig& loop, Duration span) {
  MachineFacts facts;
  {
    PeriodicThread idle{"check", loop, [](TimePoint) {}};
    const SteadyClock clock;
    clock.sleep_until(clock.now() + span);
    facts.loop = idle.stop();
  }
  facts.clock_source =
      first_word_of("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  facts.governor = first_word_of("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  facts.processors = usable_processors();
  const UdpSocketConfig socket;
  facts.receive_buffer_want = socket.receive_buffer;
  facts.receive_buffer = granted_buffer(socket.receive_buffer);
  return facts;
}

std::vector<MachineFinding> judge_machine(const MachineFacts& facts, Duration period) {
  return {scheduling(facts.loop.grant),
          memory(facts.loop.grant),
          timer(facts.loop, period),
          clock_of(facts.clock_source),
          governor_of(facts.governor),
          processors_of(facts.processors),
          buffer_of(facts.receive_buffer, facts.receive_buffer_want)};
}

}  // namespace palp::io
