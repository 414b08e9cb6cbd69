#include "review/site_data.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/record/mapped_file.h"
#include "common/record/session_encoder.h"
#include "common/record/session_reader.h"
#include "common/record/session_writer.h"

namespace palp::review {
namespace {

/// Sorts records into SiteData.
struct Collector {
  SiteData& data;

  void operator()(const SiteTick& tick) const {
    data.motion.push_back({.at = tick.at,
                           .position = tick.position,
                           .velocity = tick.velocity,
                           .force = tick.force,
                           .place = tick.place});
    data.states.push_back(tick.state);
  }
  void operator()(const HandReading& hand) const {
    const std::uint32_t before = data.phases.empty() ? 0 : data.phases.back().phase;
    if (hand.script_phase != before) data.phases.push_back({hand.at, hand.script_phase});
  }
  void operator()(const Note& note) const { data.notes.push_back(note); }
  void operator()(const LinkHeard& heard) const {
    const bool known = !data.sessions.empty() && data.sessions.back().id == heard.session_id;
    if (heard.session_id != 0 && !known) data.sessions.push_back({heard.session_id, heard.at});
  }
  void operator()(const LinkStatus& status) const {
    data.links.push_back(status);
    data.last_link = status;
    if (status.health.state == LinkState::Live && status.health.round_trip > Duration{0}) {
      data.round_trips.push_back(status.health.round_trip);
    }
  }
  void operator()(const Transition& transition) const { data.transitions.push_back(transition); }
  void operator()(const DepthEstimate& estimate) const { data.estimates.push_back(estimate); }
  void operator()(const DepthArrived& arrived) const { data.reports.push_back(arrived); }
  void operator()(const PlantTruth& truth) const { data.truths.push_back(truth); }
  template <class Other>
  void operator()(const Other& /*is of no use here*/) const {}
};

}  // namespace

std::optional<std::string> SiteData::entry(const std::string& key) const {
  const auto found = std::find_if(
      metadata.begin(), metadata.end(), [&](const auto& pair) { return pair.first == key; });
  return found == metadata.end() ? std::nullopt : std::optional{found->second};
}

std::optional<double> SiteData::number(const std::string& key) const {
  const auto text = entry(key);
  double value{};
  if (!text) return std::nullopt;
  const char* const end = text->data() + text->size();
  const auto [stop, error] = std::from_chars(text->data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return std::isfinite(value) ? std::optional{value} : std::nullopt;
}

Result<SiteData> load_site(const std::string& path, link::Role site) {
  const auto file = record::MappedFile::open(path);
  if (!file) {
    return tl::unexpected(file.error());
  }
  return load_site(file->bytes(), path, site);
}

Result<SiteData> load_site(const record::FileBytes& file,
                           const std::string& name,
                           link::Role site) {
  SiteData data;
  data.site = site;
  record::SessionReader reader{file};
  while (const auto entry = reader.next()) {
    if (entry->site != site) {
      return fail(name + " is the session file of the " +
                  std::string{record::site_name(entry->site)} + ", not of the " +
                  std::string{record::site_name(site)});
    }
    ++data.records;
    std::visit(Collector{data}, entry->record);
  }
  data.report = reader.report();
  if (data.report.messages == 0) {
    return fail(name + ": " +
                (data.report.faults.empty() ? "there is no message of a session in it"
                                            : data.report.faults.front().text));
  }
  data.began_at = reader.began_at().value_or(TimePoint{});
  data.clock = reader.clock();
  data.metadata = reader.metadata("palp");
  data.program_report = reader.metadata(record::kReportRecord, record::kReportKey);
  data.peer = reader.metadata("palp.peer");
  data.records_dropped = reader.metadata("palp.summary", "records_dropped");
  if (const auto text = reader.attachment("config.textproto")) {
    data.settings = std::string{*text};
  }
  if (const auto csv = reader.attachment("tissue.csv")) {
    data.tissue_csv = std::string{*csv};
  }
  return data;
}

}  // namespace palp::review
