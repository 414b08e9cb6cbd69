#include "review/demo_report.h"

#include <algorithm>
#include <cmath>

#include "common/config/json.h"
#include "common/core/median.h"
#include "common/core/place_text.h"
#include "common/message/health_counters.h"
#include "common/record/notes.h"
#include "common/record/session_encoder.h"
#include "judge/map_json.h"

namespace palp::review {
namespace {

using config::Json;

Json value(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }
Json value(const std::optional<double>& number) { return number ? value(*number) : Json(nullptr); }
Json value(const std::optional<std::string>& text) { return text ? Json(*text) : Json(nullptr); }
Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }
Json millimetres(const std::optional<double>& metres) {
  return metres ? value(*metres * 1e3) : Json(nullptr);
}

/// Null for text that is absent or no JSON object.
Json parsed(const std::string& text) {
  Json document = Json::parse(text);
  return document.is_object() ? document : Json(nullptr);
}

/// The member of an object, or null: reports of other versions may lack it.
Json member(const Json& object, const char* key) {
  return object.is_object() && object.contains(key) ? object[key] : Json(nullptr);
}

Json first_known(std::initializer_list<Json> candidates) {
  const auto known = std::find_if(
      candidates.begin(), candidates.end(), [](const Json& json) { return !json.is_null(); });
  return known == candidates.end() ? Json(nullptr) : *known;
}

Json whole_number(const std::optional<std::string>& text) {
  const Json number = text ? Json::parse(*text) : Json(nullptr);
  return number.is_unsigned() ? number : value(text);
}

Json phantom_json(const SiteData& patient) {
  return {{"name", value(patient.entry("phantom_name"))},
          {"depth_mm", value(patient.number("phantom_depth_mm"))},
          {"radius_mm", value(patient.number("phantom_radius_mm"))},
          {"ratio", value(patient.number("phantom_ratio"))},
          {"shape", value(patient.entry("phantom_shape"))},
          {"x_mm", value(patient.number("phantom_x_mm"))},
          {"y_mm", value(patient.number("phantom_y_mm"))}};
}

std::optional<double> round_trip_median_ms(const SiteData& site) {
  std::vector<double> values;
  for (const LinkPoint& point : site.links) {
    const bool measured = point.state == LinkState::Live && point.round_trip > Duration{0};
    if (measured) values.push_back(seconds(point.round_trip) * 1e3);
  }
  return median(values);
}

Json direction_json(const Json& relay, const char* direction) {
  const Json from = member(relay, direction);
  if (from.is_null()) {
    return nullptr;
  }
  Json to;
  for (const char* key : {"delay_p50_ms",
                          "delay_p99_ms",
                          "jitter_ms",
                          "sent",
                          "received",
                          "lost",
                          "reordered",
                          "duplicated"}) {
    to[key] = member(from, key);
  }
  return to;
}

Json link_json(const Asked& asked,
               const SessionPair& session,
               const Json& report,
               const Json& relay) {
  const SiteData& surgeon = session.surgeon;
  Json link;
  link["asked"] = {{"rtt_ms", value(asked.rtt_ms)},
                   {"jitter_ms", value(asked.jitter_ms)},
                   {"loss", value(asked.loss)}};
  link["achieved"]["rtt_p50_ms"] =
      first_known({member(report, "round_trip_p50_ms"), value(round_trip_median_ms(surgeon))});
  const auto& last = surgeon.last_link;
  link["achieved"]["telegrams_lost"] =
      first_known({member(report, "lost"), last ? Json(last->health.lost) : Json(nullptr)});
  link["achieved"]["telegrams_accepted"] =
      first_known({member(report, "accepted"), last ? Json(last->health.accepted) : Json(nullptr)});
  const auto& there = session.patient.last_link;
  link["achieved"]["telegrams_lost_to_patient"] = there ? Json(there->health.lost) : Json(nullptr);
  link["achieved"]["telegrams_accepted_by_patient"] =
      there ? Json(there->health.accepted) : Json(nullptr);
  link["achieved"]["up"] = direction_json(relay, "up");
  link["achieved"]["down"] = direction_json(relay, "down");
  return link;
}

/// What the depth of a tap and that of all taps have in common.
Json statement_json(const judge::DepthStatement& depth, bool with_stddev) {
  Json json;
  json["verdict"] = to_string(depth.verdict);
  json["depth_mm"] = millimetres(depth.depth);
  json["low_mm"] = millimetres(depth.low);
  json["high_mm"] = millimetres(depth.high);
  if (with_stddev) json["stddev_mm"] = millimetres(depth.stddev);
  json["excluded_above_mm"] = millimetres(depth.excluded);
  json["says"] = depth.says;
  return json;
}

Json tap_json(const Tap& tap, const SessionPair& session) {
  const SiteData& patient = session.patient;
  const DepthEstimate& estimate = tap.estimate;
  Json json;
  json["site"] = place_text(tap.place);
  json["index"] = tap.index;
  json["kind"] = to_string(tap.kind);
  json["number"] = estimate.number;
  json["t_s"] = value(seconds(elapsed(session.surgeon.began_at, tap.began_at)));
  json["x_mm"] = value(estimate.place.x * 1e3);
  json["y_mm"] = value(estimate.place.y * 1e3);
  json["indentation_max_mm"] = value(estimate.indentation_max * 1e3);
  json["force_max_n"] = value(estimate.force_max);
  json["stiffness_felt_n_per_m"] = value(tap.stiffness.felt());
  json["stiffness_true_n_per_m"] = value(tap.stiffness.truth());
  Json& depth = json["depth"];
  depth = statement_json(judge::statement_of(estimate), true);
  depth["h_n"] = value(estimate.hash);
  depth["reason"] = to_string(estimate.reason);
  depth["estimator"] = value(patient.entry("estimator"));
  return json;
}

/// Of a touch that no estimate came of.
Json touch_json(const judge::Excursion& touch, TimePoint began_at) {
  return {{"site", place_text(touch.place)},
          {"t_s", value(seconds(elapsed(began_at, touch.contact_at)))},
          {"until_s", value(seconds(elapsed(began_at, touch.ended_at)))},
          {"x_mm", value(touch.place.x * 1e3)},
          {"y_mm", value(touch.place.y * 1e3)},
          {"indentation_max_mm", value(touch.indentation_max * 1e3)},
          {"stiffness_felt_n_per_m", value(touch.stiffness.felt())},
          {"stiffness_true_n_per_m", value(touch.stiffness.truth())}};
}

Json depth_json(const std::optional<judge::DepthStatement>& depth) {
  if (depth) return statement_json(*depth, false);
  Json json;
  for (const char* key :
       {"verdict", "depth_mm", "low_mm", "high_mm", "excluded_above_mm", "says"}) {
    json[key] = nullptr;
  }
  return json;
}

Json rejected_json(const SiteData& site, const Json& report) {
  Json told = member(report, "rejected");
  if (!told.is_null() || !site.last_link) {
    return told;
  }
  Json json;
  for (const auto& [reason, count] : message::refusals_of(site.last_link->health)) {
    json[std::string{reason}] = count;
  }
  return json;
}

/// What the site's program reported in its file.
Json told_by(const SiteData& site) { return parsed(site.texts.program_report.value_or("")); }

Json site_json(const SiteData& site, const Json& report, const std::string& path) {
  Json json;
  json["session_file"] = first_known({member(report, "session_file"), path});
  json["closed"] = site.report.closed;
  json["lack"] = text_or_null(site.report.lack);
  json["messages"] = site.report.messages;
  json["ticks"] = first_known({member(report, "ticks"), site.ticks});
  json["missed_ticks"] = member(report, "missed_ticks");
  json["lateness_p999_us"] = member(report, "lateness_p999_us");
  json["records_written"] = first_known({member(report, "records_written"), site.records});
  json["records_dropped"] =
      first_known({member(report, "records_dropped"), whole_number(site.records_dropped)});
  json["rejected"] = rejected_json(site, report);
  Json late;
  Json repaired;
  if (site.last_link) {
    late = site.last_link->health.late;
    repaired = site.last_link->health.repaired;
  }
  json["late"] = first_known({member(report, "late"), late});
  json["repaired"] = first_known({member(report, "repaired"), repaired});
  return json;
}

Result<void> check_report(const SiteData& site, const Json& report) {
  if (report.is_null()) return {};
  const std::string name{record::site_name(site.site)};
  const Json told = told_by(site);
  if (told.is_null() && site.entry("time") == "virtual") {
    return fail("the " + name + "'s file is of a simulation, which has no report of a site");
  }
  if (const Json of = member(report, "site"); !of.is_null() && of.text() != name) {
    return fail("the report given for the " + name + "'s site is of another: " + of.dump());
  }
  for (const char* const key : {"seed", "ticks", "sent", "accepted", "lateness_max_us"}) {
    const Json in_file = member(told, key);
    const Json in_report = member(report, key);
    if (in_file.is_null() || in_report.is_null()) continue;
    if (in_file.dump() == in_report.dump()) continue;
    return fail("the report given for the " + name + "'s site is of another session: " + key +
                " is " + in_report.dump() + ", in the session file " + in_file.dump());
  }
  return {};
}

/// [s] since the surgeon's file begins, on the surgeon's line of time.
double instant(const SessionPair& session, const SiteData& site, TimePoint at) {
  const bool surgeons = &site == &session.surgeon;
  return seconds(elapsed(session.surgeon.began_at, surgeons ? at : session.time_line.surgeons(at)));
}

Json transitions_json(const SessionPair& session) {
  struct Entry {
    double t{};  ///< [s]
    const SiteData* site{};
    const Transition* transition{};
  };
  std::vector<Entry> entries;
  for (const SiteData* site : {&session.surgeon, &session.patient}) {
    for (const Transition& transition : site->transitions) {
      entries.push_back({instant(session, *site, transition.at), site, &transition});
    }
  }
  std::stable_sort(
      entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.t < b.t; });
  Json list = Json::array();
  for (const Entry& entry : entries) {
    list.push_back({{"site", record::site_name(entry.site->site)},
                    {"t_s", value(entry.t)},
                    {"from", to_string(entry.transition->from)},
                    {"to", to_string(entry.transition->to)},
                    {"reason", record::note_text(entry.transition->reason)}});
  }
  return list;
}

/// The moments that the operators marked.
Json marks_json(const SessionPair& session) {
  Json list = Json::array();
  for (const SiteData* site : {&session.surgeon, &session.patient}) {
    for (const Note& note : site->notes) {
      if (note.code != static_cast<std::uint16_t>(record::NoteCode::Marked)) continue;
      list.push_back({{"site", record::site_name(site->site)},
                      {"t_s", value(instant(session, *site, note.at))},
                      {"number", value(note.detail)}});
    }
  }
  return list;
}

}  // namespace

Result<void> check_reports(const SessionPair& session, const ProgramReports& reports) {
  if (auto ours = check_report(session.surgeon, parsed(reports.surgeon)); !ours) return ours;
  return check_report(session.patient, parsed(reports.patient));
}

std::string demo_report(const SessionPair& session,
                        const Touches& touches,
                        const Asked& asked,
                        const ProgramReports& reports,
                        const SessionPaths& paths,
                        const config::Json& metrics) {
  const SiteData& surgeon = session.surgeon;
  const SiteData& patient = session.patient;
  const Json surgeon_report = first_known({parsed(reports.surgeon), told_by(surgeon)});
  const Json patient_report = first_known({parsed(reports.patient), told_by(patient)});
  Json json;
  json["schema"] = "palp.demo/1";
  json["outcome"] = first_known({text_or_null(asked.outcome),
                                 member(surgeon_report, "outcome"),
                                 member(patient_report, "outcome")});
  json["seed"] = first_known({member(surgeon_report, "seed"), whole_number(surgeon.entry("seed"))});
  json["coupling"] =
      first_known({member(surgeon_report, "coupling"), value(surgeon.entry("coupling"))});
  json["preset"] = text_or_null(asked.preset);
  json["grip"] = first_known({text_or_null(asked.grip), value(surgeon.entry("grip"))});
  json["phantom"] = phantom_json(patient);
  json["link"] = link_json(asked, session, surgeon_report, parsed(reports.relay));
  json["taps"] = Json::array();
  for (const Tap& tap : touches.taps) {
    json["taps"].push_back(tap_json(tap, session));
  }
  json["other_touches"] = Json::array();
  for (const judge::Excursion& touch : touches.others) {
    json["other_touches"].push_back(touch_json(touch, surgeon.began_at));
  }
  json["depth"] = depth_json(overall_depth(touches.taps));
  json["map"] = judge::map_json(patient.map.report, patient.map.cells);
  json["metrics"] = metrics;
  json["sites"]["surgeon"] = site_json(surgeon, surgeon_report, paths.surgeon);
  json["sites"]["patient"] = site_json(patient, patient_report, paths.patient);
  json["transitions"] = transitions_json(session);
  json["marks"] = marks_json(session);
  return json.dump(2) + '\n';
}

}  // namespace palp::review
