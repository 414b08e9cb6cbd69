#include "site_program/site_report.h"

#include <algorithm>
#include <string_view>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/io/process/diagnostics.h"
#include "common/message/health_counters.h"

namespace palp::site_program {
namespace {

using config::Json;

double microseconds(Duration span) { return static_cast<double>(span.count()) * 1e-3; }

Json milliseconds(const std::optional<Duration>& span) {
  if (!span) return nullptr;
  return static_cast<double>(span->count()) * 1e-6;
}

Json records_json(const RecordAccount& account) {
  Json json;
  for (std::size_t type = 0; type < kRecordNames.size(); ++type) {
    json[kRecordNames[type]] = account.counts.by_type[type];
  }
  return json;
}

/// On the link and beside it, in one: datagrams that were of no use to this site.
Json rejected_json(const LinkHealth& link, const link::SessionCounters& noise) {
  Json json;
  for (const auto& [reason, count] : message::refusals_of(link)) json[std::string{reason}] = count;
  json["malformed"] = link.malformed + noise.malformed;
  json["foreign"] = link.foreign + noise.foreign;
  return json;
}

/// null where there never was an estimate.
Json clock_json(const std::optional<LinkHealth>& link) {
  if (!link) return nullptr;
  const ClockOffset& clock = *link->peer_clock;
  return {{"offset_ms", milliseconds(clock.offset)},
          {"uncertainty_ms", milliseconds(clock.uncertainty)},
          {"skew_ppm", clock.skew * 1e6},
          {"delay_out_ms", milliseconds(link->delay_out)},
          {"delay_in_ms", milliseconds(link->delay_in)}};
}

/// What the program alone knows of its run.
Json figures_json(const SiteReport& report) {
  const io::LoopStats& loop = report.loop;
  const LinkHealth& link = report.link;
  Json json;
  json["schema"] = "palp.site/2";
  json["site"] = report.site;
  json["outcome"] = report.exit_status.outcome;
  json["reason"] = report.exit_status.reason;
  json["exit_code"] = config::exit_value(report.exit_status.code);
  json["seed"] = report.seed;
  json["coupling"] = report.coupling;
  json["ticks"] = loop.ticks;
  json["missed_ticks"] = loop.missed;
  json["lateness_p50_us"] = microseconds(loop.lateness_p50);
  json["lateness_p99_us"] = microseconds(loop.lateness_p99);
  json["lateness_p999_us"] = microseconds(loop.lateness_p999);
  json["lateness_max_us"] = microseconds(loop.lateness_max);
  json["realtime"] = {{"priority", loop.grant.priority},
                      {"memory_locked", loop.grant.memory_locked}};
  for (const auto& [name, count] : message::counters_of(link)) json[std::string{name}] = count;
  json["rejected"] = rejected_json(link, report.noise);
  json["round_trip_p50_ms"] = milliseconds(report.round_trips.median());
  json["round_trip_min_ms"] = milliseconds(report.round_trips.least());
  json["clock"] = clock_json(report.round_trips.clocked());
  json["sessions"] = report.sessions;
  if (report.estimates) {
    json["estimates"] = *report.estimates;
    json["estimate_latency_p50_ms"] = microseconds(report.estimate_p50) / 1e3;
    json["estimate_latency_max_ms"] = microseconds(report.estimate_max) / 1e3;
  }
  return json;
}

}  // namespace

void RoundTrips::add(const LinkHealth& link) noexcept {
  if (link.peer_clock) clocked_ = link;
  if (link.state != LinkState::Live || link.round_trip <= Duration{0}) return;
  all_.record(link.round_trip);
  least_ = std::min(least_.value_or(Duration::max()), link.round_trip_min);
}

std::optional<Duration> RoundTrips::median() const noexcept {
  if (all_.count() == 0) return std::nullopt;
  return all_.quantile(0.5);
}

std::string figures_of(const SiteReport& report) { return figures_json(report).dump(); }

std::string to_json(const SiteReport& report) {
  Json json = figures_json(report);
  json["session_file"] = report.session_file.empty() ? Json(nullptr) : Json(report.session_file);
  json["records_written"] = report.records.counts.records();
  json["records_dropped"] = report.records.dropped;
  json["records"] = records_json(report.records);
  json["tick_views"] = report.records.counts.views;
  json["messages"] = report.records.messages;
  json["recording_fault"] =
      report.records.fault.empty() ? Json(nullptr) : Json(report.records.fault);
  return json.dump(2) + "\n";
}

ExitStatus with_recording(ExitStatus exit_status, const RecordAccount& records) {
  if (records.fault.empty()) return exit_status;
  const std::string sentence = "recording failed: " + records.fault;
  exit_status.reason = exit_status.reason.empty() ? sentence : exit_status.reason + "; " + sentence;
  if (exit_status.code == config::ExitCode::Done) exit_status.code = config::ExitCode::Missed;
  return exit_status;
}

int finish(const SiteReport& report, const std::string& path) {
  const std::string program = "palp-" + report.site + ": ";
  if (report.exit_status.code != config::ExitCode::Done) {
    const std::string& reason = report.exit_status.reason;
    const bool named = reason.starts_with(program);
    (void)config::leave(
        {report.exit_status.code,
         (named ? "" : program) + (reason.empty() ? report.exit_status.outcome : reason)});
  } else {
    io::info(report.exit_status.outcome + (report.session_file.empty()
                                               ? ""
                                               : ": " + std::to_string(report.records.messages) +
                                                     " messages in " + report.session_file));
  }
  config::ExitCode code = report.exit_status.code;
  if (!path.empty()) {
    if (const auto written = config::write_whole_file(path, to_json(report)); !written) {
      (void)config::leave(
          {config::ExitCode::CannotOpen, program + "--report: " + written.error().text});
      if (code == config::ExitCode::Done) code = config::ExitCode::CannotOpen;
    }
  }
  return config::leave({code, ""});
}

}  // namespace palp::site_program
