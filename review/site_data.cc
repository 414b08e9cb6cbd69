#include "review/site_data.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "common/core/median.h"
#include "common/record/session_encoder.h"
#include "common/record/session_reader.h"
#include "common/record/session_writer.h"
#include "review/lack.h"
#include "review/thinned.h"
#include "surgeon_site/script_record.h"

namespace palp::review {
namespace {

template <class T>
void keep(std::vector<T>& list, const T& one) {
  if (list.size() < kListMax) list.push_back(one);
}

LinkPoint point_of(const LinkStatus& status) {
  const LinkHealth& health = status.health;
  return {.at = status.at,
          .state = health.state,
          .round_trip = health.round_trip,
          .jitter = health.jitter,
          .delay_out = health.delay_out,
          .lost = health.lost,
          .accepted = health.accepted,
          .peer_clock = health.peer_clock};
}

/// Sorts records into SiteData.
class Collector {
 public:
  explicit Collector(SiteData& data) : data_{data} {}

  void operator()(const SiteTick& tick) {
    ++data_.ticks;
    last_tick_ = tick.at;
  }
  void operator()(const HandReading& hand) {
    const std::uint32_t before = data_.phases.empty() ? 0 : data_.phases.back().phase;
    if (hand.script_phase != before) keep(data_.phases, {hand.at, hand.script_phase});
  }
  void operator()(const Note& note) { keep(data_.notes, note); }
  void operator()(const LinkHeard& heard) {
    const bool known = !data_.sessions.empty() && data_.sessions.back().id == heard.session_id;
    if (heard.session_id == 0 || known) return;
    // The tick of this very instant is its first.
    const std::uint64_t before = data_.ticks - (last_tick_ == heard.at ? 1 : 0);
    keep(data_.sessions, {heard.session_id, heard.at, before});
  }
  void operator()(const LinkStatus& status) {
    data_.last_link = status;
    links_.add(point_of(status));
  }
  void operator()(const Transition& transition) { keep(data_.transitions, transition); }
  void operator()(const DepthEstimate& estimate) { keep(data_.estimates, estimate); }
  void operator()(const DepthArrived& arrived) { keep(data_.reports, arrived); }
  void operator()(const MapEstimate& estimate) { data_.map.report = estimate.report; }
  void operator()(const MapCell& cell) {
    if (!data_.map.cells.empty() && data_.map.cells.front().number != cell.number)
      data_.map.cells.clear();
    keep(data_.map.cells, cell);
  }
  void operator()(const MapArrived& arrived) { data_.map.report = arrived.report; }
  void operator()(const PlantTruth& truth) {
    if (!data_.run_began) data_.run_began = TimePoint{elapsed(TimePoint{truth.run_time}, truth.at)};
  }
  template <class Other>
  void operator()(const Other& /*is of no use here*/) {}

  void finish() { data_.links = links_.take(); }

 private:
  SiteData& data_;
  Thinned<LinkPoint> links_{4 * kListMax};
  std::optional<TimePoint> last_tick_;
};

}  // namespace

std::optional<std::string> text_of(const record::SessionReader& reader, const char* name) {
  constexpr std::size_t kTextMax = std::size_t{4} << 20U;  // [bytes]
  const auto text = reader.attachment(name);
  if (!text || text->size() > kTextMax) return std::nullopt;
  return std::string{*text};
}

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

double surface_of(const SiteData& patient) {
  if (const auto offset = patient.number("surface_offset_mm")) return *offset * 1e-3;
  std::vector<double> found;
  for (const DepthEstimate& estimate : patient.estimates) {
    if (estimate.reason != DepthReason::NoContact) found.push_back(estimate.surface);
  }
  return median(found).value_or(0);
}

Result<SiteData> load_site(const std::string& path, link::Role site) {
  auto file = record::MappedFile::open(path);
  if (!file) {
    return tl::unexpected(file.error());
  }
  auto data = load_site(file->bytes(), path, site);
  if (data) data->mapping = std::move(*file);
  return data;
}

Result<SiteData> load_site(const record::FileBytes& file,
                           const std::string& name,
                           link::Role site) {
  SiteData data;
  data.site = site;
  data.bytes = file;
  record::SessionReader reader{file};
  Collector collector{data};
  while (const auto entry = reader.next()) {
    if (entry->site != site) {
      return fail(name + " is the session file of the " +
                  std::string{record::site_name(entry->site)} + ", not of the " +
                  std::string{record::site_name(site)});
    }
    ++data.records;
    std::visit(collector, entry->record);
  }
  collector.finish();
  static_cast<record::McapReadReport&>(data.report) = reader.report();
  data.report.lack = lack_of(reader);
  if (data.report.messages == 0) {
    return fail(name + ": " +
                (data.report.faults.empty() ? "there is no message of a session in it"
                                            : data.report.faults.front().text));
  }
  data.began_at = reader.began_at().value_or(TimePoint{});
  data.clock = reader.clock();
  data.metadata = reader.metadata("palp");
  data.texts.program_report = reader.metadata(record::kReportRecord, record::kReportKey);
  data.peer = reader.metadata("palp.peer");
  data.records_dropped = reader.metadata("palp.summary", "records_dropped");
  data.texts.settings = text_of(reader, "config.textproto");
  data.texts.script = text_of(reader, surgeon::kScriptAttachment);
  data.texts.tissue_csv = text_of(reader, "tissue.csv");
  data.texts.tissue_words = text_of(reader, "tissue.txt");
  return data;
}

}  // namespace palp::review
