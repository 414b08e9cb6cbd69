#include "review/time_line.h"

#include <algorithm>
#include <cmath>

#include "common/core/printable.h"
#include "common/record/session_encoder.h"

namespace palp::review {
namespace {

/// A file may say anything.
bool sensible(const ClockOffset& told) noexcept {
  constexpr Duration kFar = std::chrono::hours{24 * 365 * 100};
  const auto near = [&](Duration span) { return span > -kFar && span < kFar; };
  return near(told.offset) && near(told.at.time_since_epoch()) && std::abs(told.skew) < 0.1;
}

/// The most certain offset of a site's, the latest of equals; nothing: none was told.
std::optional<ClockOffset> best_offset(const SiteData& site) {
  std::optional<ClockOffset> best;
  for (const LinkPoint& point : site.links) {
    const std::optional<ClockOffset>& told = point.peer_clock;
    if (!told || !sensible(*told)) continue;
    if (!best || told->uncertainty <= best->uncertainty) best = told;
  }
  return best;
}

/// The link measures between times that count from each side's begin of the session. @returns how
/// much later the other's line has that begin than the own one, in the session of `at`.
Duration between_begins(const SiteData& own, const SiteData& other, TimePoint at) {
  Duration between{};
  for (const SessionSpan& mine : own.sessions) {
    if (mine.began_at > at) break;
    const auto same = std::ranges::find(other.sessions, mine.id, &SessionSpan::id);
    if (same != other.sessions.end()) between = elapsed(mine.began_at, same->began_at);
  }
  return between;
}

template <class Timed>
void keep_between(std::vector<Timed>& list, TimePoint from, TimePoint to, const auto& instant) {
  std::erase_if(list, [&](const Timed& one) { return instant(one) < from || instant(one) >= to; });
}

/// Leaves out what is not between.
void keep_between(SiteData& site, TimePoint from, TimePoint to) {
  const auto at = [](const auto& one) { return one.at; };
  site.from = from;
  site.to = to;
  keep_between(site.phases, from, to, at);
  keep_between(site.notes, from, to, at);
  keep_between(site.transitions, from, to, at);
  keep_between(site.links, from, to, at);
  keep_between(site.reports, from, to, at);
  keep_between(
      site.estimates, from, to, [](const DepthEstimate& one) { return one.stroke_ended_at; });
}

bool names(const SiteData& site, std::uint64_t id) {
  return std::ranges::any_of(site.sessions, [&](const auto& one) { return one.id == id; });
}

std::string ids_of(const SiteData& site) {
  std::string text;
  for (const SessionSpan& session : site.sessions) {
    text += (text.empty() ? "" : ", ") + record::session_id_text(session.id);
  }
  return text;
}

/// From the begin of its first session that the other names too to that of the next it does not.
void keep_common(SiteData& site, const SiteData& other) {
  const auto common = [&](const SessionSpan& one) { return names(other, one.id); };
  const auto first = std::ranges::find_if(site.sessions, common);
  const auto behind = std::find_if_not(first, site.sessions.end(), common);
  // What a site did before its first session belongs to that.
  const TimePoint from = first == site.sessions.begin() ? TimePoint::min() : first->began_at;
  const bool last = behind == site.sessions.end();
  const std::uint64_t before = from == TimePoint::min() ? 0 : first->ticks_before;
  site.ticks = (last ? site.ticks : behind->ticks_before) - before;
  keep_between(site, from, last ? TimePoint::max() : behind->began_at);
}

}  // namespace

TimePoint TimeLine::surgeons(TimePoint patients) const noexcept {
  const TimePoint near{elapsed(TimePoint{offset}, patients)};
  const Duration drift = from_seconds(std::clamp(skew * seconds(elapsed(at, near)), -1e9, 1e9));
  return TimePoint{elapsed(TimePoint{drift}, near)};
}

TimeLine time_line_of(const SiteData& surgeon, const SiteData& patient) {
  TimeLine line;
  if (const auto told = best_offset(surgeon)) {
    return {.offset = told->offset + between_begins(surgeon, patient, told->at),
            .skew = told->skew,
            .at = told->at,
            .uncertainty = told->uncertainty,
            .known = true,
            .source = "the surgeon's clock exchange"};
  }
  if (const auto told = best_offset(patient)) {
    const Duration offset = told->offset + between_begins(patient, surgeon, told->at);
    return {.offset = -offset,
            .skew = -told->skew,
            .at = told->at + offset,
            .uncertainty = told->uncertainty,
            .known = true,
            .source = "the patient's clock exchange"};
  }
  if (surgeon.clock.ahead != Duration{} && patient.clock.ahead != Duration{}) {
    line.offset = elapsed(TimePoint{patient.clock.ahead}, TimePoint{surgeon.clock.ahead});
    line.source = "the wall clocks of both sites, as they were set";
    return line;
  }
  line.source = "nothing: the sites are taken to have one clock";
  return line;
}

Result<SessionPair> pair_of(SiteData surgeon, SiteData patient) {
  SessionPair pair{std::move(surgeon), std::move(patient), {}, {}};
  const auto& here = pair.surgeon.sessions;
  const auto shared = std::ranges::find_if(
      here, [&](const SessionSpan& one) { return names(pair.patient, one.id); });
  if (!here.empty() && !pair.patient.sessions.empty()) {
    if (shared == here.end()) {
      return fail("the files are of different sessions: the surgeon's of " + ids_of(pair.surgeon) +
                  ", the patient's of " + ids_of(pair.patient));
    }
    pair.session_id = record::session_id_text(shared->id);
    keep_common(pair.surgeon, pair.patient);
    keep_common(pair.patient, pair.surgeon);
  }
  pair.time_line = time_line_of(pair.surgeon, pair.patient);
  return pair;
}

std::string lack_lines(const SessionPair& session) {
  std::string lines;
  for (const SiteData* site : {&session.surgeon, &session.patient}) {
    if (site->report.lack.empty()) continue;
    lines +=
        "the " + std::string{record::site_name(site->site)} + "'s file " + site->report.lack + '\n';
  }
  return lines;
}

Result<SessionPair> load_pair(const std::string& surgeon, const std::string& patient) {
  auto of_surgeon = load_site(surgeon, link::Role::Surgeon);
  if (!of_surgeon) return tl::unexpected(of_surgeon.error());
  auto of_patient = load_site(patient, link::Role::Patient);
  if (!of_patient) return tl::unexpected(of_patient.error());
  return pair_of(std::move(*of_surgeon), std::move(*of_patient));
}

}  // namespace palp::review
