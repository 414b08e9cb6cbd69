#include "netem/relay/relay_report.h"

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

ordered_json deviation_ms(const Histogram& histogram) {
  if (histogram.count() == 0) return nullptr;
  return milliseconds(histogram.deviation());
}

std::uint64_t lost_in(const ChannelCounters& counters) {
  return counters.lost + counters.header_hit + counters.blackout + counters.over_limit;
}

ordered_json direction_report(const Relay& relay, Direction direction, const std::string& asked) {
  const Channel& channel = relay.channel(direction);
  const ChannelCounters& counters = channel.counters();
  const RelayTraffic traffic = relay.traffic(direction);
  ordered_json report;
  report["asked"] = asked;
  report["sent"] = counters.pushed;
  report["received"] = traffic.forwarded;
  report["lost"] = lost_in(counters);
  report["lost_in_blackout"] = counters.blackout;
  report["lost_over_limit"] = counters.over_limit;
  report["lost_header_hit"] = counters.header_hit;
  report["corrupted"] = counters.corrupted;
  report["duplicated"] = counters.copies;
  report["reordered"] = counters.reordered;
  report["in_flight"] = channel.in_flight();
  report["unsent"] = traffic.unsent;
  report["delay_min_ms"] = quantile_ms(traffic.delay, 0);
  report["delay_mean_ms"] = mean_ms(traffic.delay);
  report["jitter_ms"] = deviation_ms(traffic.delay);
  report["delay_p50_ms"] = quantile_ms(traffic.delay, 0.5);
  report["delay_p99_ms"] = quantile_ms(traffic.delay, 0.99);
  report["intended_delay_p50_ms"] = quantile_ms(channel.intended_delay(), 0.5);
  report["intended_delay_p99_ms"] = quantile_ms(channel.intended_delay(), 0.99);
  report["release_error_p50_us"] = quantile_us(traffic.release_error, 0.5);
  report["jitter_p99_p50_ms"] =
      traffic.delay.count() == 0
          ? ordered_json(nullptr)
          : ordered_json(milliseconds(traffic.delay.quantile(0.99) - traffic.delay.quantile(0.5)));
  report["release_error_p99_us"] = quantile_us(traffic.release_error, 0.99);
  report["late_releases"] = traffic.late_releases;
  report["socket_errors"] = traffic.socket_errors;
  report["changes_applied"] = channel.impaired_path().changes_applied();
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

std::string status_line(const RelayStatus& status, TimePoint start) {
  std::string text;
  char part[240];
  std::snprintf(part, sizeof part, "%.1f s", seconds(status.at - start));
  text = part;
  for (const std::size_t i : {0U, 1U}) {
    const RelayStatus::Way& way = status.ways[i];
    std::snprintf(part,
                  sizeof part,
                  " | %s sent %llu, lost %llu, waiting %zu, delay p50 %.3f p99 %.3f ms, "
                  "late %llu, errors %llu",
                  i == 0 ? "up" : "down",
                  static_cast<unsigned long long>(way.counters.pushed),
                  static_cast<unsigned long long>(lost_in(way.counters)),
                  way.in_flight,
                  milliseconds(way.delay_p50),
                  milliseconds(way.delay_p99),
                  static_cast<unsigned long long>(way.late_releases),
                  static_cast<unsigned long long>(way.socket_errors));
    text += part;
  }
  return text;
}

std::string status_json(const RelayStatus& status,
                        TimePoint start,
                        const std::array<std::string, 2>& laws) {
  ordered_json report;
  report["at_s"] = seconds(status.at - start);
  report["client"] =
      status.client.valid() ? ordered_json(status.client.to_string()) : ordered_json(nullptr);
  for (const std::size_t i : {0U, 1U}) {
    const RelayStatus::Way& way = status.ways[i];
    ordered_json& part = report[i == 0 ? "up" : "down"];
    part["sent"] = way.counters.pushed;
    part["received"] = way.forwarded;
    part["lost"] = lost_in(way.counters);
    part["lost_in_blackout"] = way.counters.blackout;
    part["lost_over_limit"] = way.counters.over_limit;
    part["duplicated"] = way.counters.copies;
    part["reordered"] = way.counters.reordered;
    part["in_flight"] = way.in_flight;
    part["delay_p50_ms"] = milliseconds(way.delay_p50);
    part["delay_p99_ms"] = milliseconds(way.delay_p99);
    part["release_error_p99_us"] = milliseconds(way.error_p99) * 1e3;
    part["late_releases"] = way.late_releases;
    part["socket_errors"] = way.socket_errors;
    part["changes_applied"] = way.changes;
    part["law"] = laws[i];
  }
  return report.dump();
}

std::string recording_end_line(const RecordingGaps& gaps) {
  return ordered_json{{"recording", false}, {"missed", gaps.missed}, {"open", gaps.open}}.dump();
}

std::string error_line(const std::string& sentence) {
  return ordered_json{{"error", sentence}}.dump(
      -1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string relay_summary(const Relay& relay) {
  return direction_summary(relay, Direction::Up) + direction_summary(relay, Direction::Down);
}

}  // namespace palp::netem
