#include "netem/relay_report.h"

#include <cstdio>

#include <nlohmann/json.hpp>

namespace palp::netem {
namespace {

using nlohmann::ordered_json;

double milliseconds(Duration span) { return static_cast<double>(span.count()) * 1e-6; }

/// null while there is nothing to tell.
ordered_json quantile_ms(const Histogram& histogram, double share) {
  if (histogram.count() == 0) return nullptr;
  return milliseconds(histogram.quantile(share));
}

ordered_json quantile_us(const Histogram& histogram, double share) {
  if (histogram.count() == 0) return nullptr;
  return milliseconds(histogram.quantile(share)) * 1e3;
}

ordered_json mean_ms(const Histogram& histogram) {
  if (histogram.count() == 0) return nullptr;
  return milliseconds(histogram.mean());
}

std::uint64_t lost_in(const ChannelCounters& counters) {
  return counters.lost + counters.blackout + counters.over_limit;
}

ordered_json direction_report(const Relay& relay, Direction direction, const Impairment& asked) {
  const Channel& channel = relay.channel(direction);
  const ChannelCounters& counters = channel.counters();
  const RelayTraffic traffic = relay.traffic(direction);
  ordered_json report;
  report["asked"] = to_string(asked);
  report["sent"] = counters.pushed;
  report["received"] = traffic.forwarded;
  report["lost"] = lost_in(counters);
  report["lost_in_blackout"] = counters.blackout;
  report["lost_over_limit"] = counters.over_limit;
  report["duplicated"] = counters.copies;
  report["reordered"] = counters.reordered;
  report["in_flight"] = channel.in_flight();
  report["unsent"] = traffic.unsent;
  report["delay_min_ms"] = quantile_ms(traffic.delay, 0);
  report["delay_mean_ms"] = mean_ms(traffic.delay);
  report["delay_p50_ms"] = quantile_ms(traffic.delay, 0.5);
  report["delay_p99_ms"] = quantile_ms(traffic.delay, 0.99);
  report["intended_delay_p50_ms"] = quantile_ms(channel.intended_delay(), 0.5);
  report["intended_delay_p99_ms"] = quantile_ms(channel.intended_delay(), 0.99);
  report["release_error_p50_us"] = quantile_us(traffic.release_error, 0.5);
  report["release_error_p99_us"] = quantile_us(traffic.release_error, 0.99);
  report["late_releases"] = traffic.late_releases;
  report["socket_errors"] = traffic.socket_errors;
  return report;
}

std::string direction_summary(const Relay& relay, Direction direction) {
  const ChannelCounters& counters = relay.channel(direction).counters();
  const RelayTraffic traffic = relay.traffic(direction);
  char line[200];
  std::snprintf(line,
                sizeof line,
                "%-4s sent %llu, received %llu, lost %llu, delay p50 %.3f ms, p99 %.3f ms, "
                "socket errors %llu\n",
                direction == Direction::Up ? "up" : "down",
                static_cast<unsigned long long>(counters.pushed),
                static_cast<unsigned long long>(traffic.forwarded),
                static_cast<unsigned long long>(lost_in(counters)),
                milliseconds(traffic.delay.quantile(0.5)),
                milliseconds(traffic.delay.quantile(0.99)),
                static_cast<unsigned long long>(traffic.socket_errors));
  return line;
}

}  // namespace

std::string relay_report(const Relay& relay, const RelayRun& run) {
  ordered_json report;
  report["schema"] = "palp.relay/1";
  report["preset"] = run.preset.empty() ? ordered_json(nullptr) : ordered_json(run.preset);
  report["seed"] = run.seed;
  report["listen"] = relay.listening_on().to_string();
  report["forward"] = run.forward.to_string();
  report["duration_s"] = seconds(run.duration);
  report["real_time"] = relay.real_time();
  report["up"] = direction_report(relay, Direction::Up, run.up);
  report["down"] = direction_report(relay, Direction::Down, run.down);
  return report.dump(2) + "\n";
}

std::string relay_summary(const Relay& relay) {
  return direction_summary(relay, Direction::Up) + direction_summary(relay, Direction::Down);
}

}  // namespace palp::netem
