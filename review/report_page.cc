#include "review/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "common/config/json.h"
#include "common/record/notes.h"
#include "judge/excursions.h"
#include "review/page_texts.h"
#include "review/text.h"

namespace palp::review {
namespace {

using config::Json;

constexpr std::size_t kCurvePoints = 6000;
constexpr double kTickPeriod = 1e-3;  ///< [s]
constexpr std::size_t kLoopPoints = 150;
constexpr std::size_t kLoopsMax = 60;

/// Rounded to what a screen shows.
Json shown(double value, double unit) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / unit * 1e4) * 1e-4;
}

/// Each n-th of a list, so that about `most` are left.
std::size_t stride_for(std::size_t size, std::size_t most) { return size / most + 1; }

void add_curves(const SessionTicks& session, Json& to) {
  for (const char* name :
       {"t", "felt", "touched", "truth", "hand", "tip", "x", "y", "energy", "energy_tissue"}) {
    to[name] = Json::array();
  }
  const std::size_t step = stride_for(session.ticks.size(), kCurvePoints);
  double tissue = 0;  // [J]
  for (std::size_t i = 0; i < session.ticks.size(); ++i) {
    const judge::RunTick& tick = session.ticks[i];
    if (std::isfinite(tick.tip)) tissue += tick.contact_force * tick.tip_velocity * kTickPeriod;
    if (i % step != 0) continue;
    to["t"].push_back(shown(tick.at, 1));
    to["felt"].push_back(shown(tick.hand_force, 1));
    to["touched"].push_back(shown(tick.contact_force, 1));
    to["truth"].push_back(shown(tick.force_true, 1));
    to["hand"].push_back(shown(tick.hand, 1e-3));
    to["tip"].push_back(shown(tick.tip, 1e-3));
    to["x"].push_back(shown(tick.tip_place.x, 1e-3));
    to["y"].push_back(shown(tick.tip_place.y, 1e-3));
    to["energy"].push_back(shown(tick.energy_operator, 1e-3));
    to["energy_tissue"].push_back(shown(tissue, 1e-3));
  }
}

void add_link(const SessionPair& session, Json& to) {
  for (const char* name : {"t", "rtt", "jitter", "lost", "sent"}) to[name] = Json::array();
  const std::vector<LinkStatus>& links = session.surgeon.links;
  const std::size_t step = stride_for(links.size(), kCurvePoints);
  for (std::size_t i = 0; i < links.size(); i += step) {
    const LinkHealth& health = links[i].health;
    const bool measured = health.round_trip > Duration{0};
    to["t"].push_back(shown(seconds(elapsed(session.surgeon.began_at, links[i].at)), 1));
    to["rtt"].push_back(measured ? shown(seconds(health.round_trip), 1e-3) : Json(nullptr));
    to["jitter"].push_back(measured ? shown(seconds(health.jitter), 1e-3) : Json(nullptr));
    to["lost"].push_back(health.lost);
    to["sent"].push_back(health.accepted + health.lost);
  }
}

/// When the hand was not engaged, as pairs of instants [s].
void add_idle(const SessionTicks& session, Json& to) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= session.ticks.size(); ++i) {
    if (i < session.ticks.size() && !session.ticks[i].counted) continue;
    if (i > begin) to.push_back({session.ticks[begin].at, session.ticks[i - 1].at});
    begin = i + 1;
  }
}

/// The operators' marks on the surgeon's line of time [s].
void add_marks(const SessionPair& session, Json& to) {
  for (const SiteData* site : {&session.surgeon, &session.patient}) {
    for (const Note& note : site->notes) {
      if (note.code != static_cast<std::uint16_t>(record::NoteCode::Marked)) continue;
      const bool surgeon = site == &session.surgeon;
      const TimePoint at = surgeon ? note.at : session.time_line.surgeons(note.at);
      to.push_back(shown(seconds(elapsed(session.surgeon.began_at, at)), 1));
    }
  }
}

/// Force over indentation of each time the hand went in.
void add_loops(const SessionTicks& session, Json& to) {
  const std::vector<judge::RunTick>& ticks = session.ticks;
  std::size_t begin = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i <= ticks.size() && count < kLoopsMax; ++i) {
    if (i < ticks.size() && ticks[i].hand > 0 && ticks[i].counted) continue;
    const std::span<const judge::RunTick> stroke{ticks.data() + begin, i - begin};
    begin = i + 1;
    const auto deepest = std::ranges::max_element(stroke, {}, &judge::RunTick::hand);
    if (deepest == stroke.end() || deepest->hand <= judge::kStrokeDepthMin) continue;
    Json loop{{"name", "stroke " + std::to_string(++count)}, {"at", stroke.front().at}};
    for (const char* name : {"d", "felt", "truth"}) loop[name] = Json::array();
    const std::size_t step = stride_for(stroke.size(), kLoopPoints);
    for (std::size_t k = 0; k < stroke.size(); k += step) {
      loop["d"].push_back(shown(stroke[k].hand, 1e-3));
      loop["felt"].push_back(shown(stroke[k].hand_force, 1));
      loop["truth"].push_back(shown(stroke[k].force_true, 1));
    }
    to.push_back(loop);
  }
}

Json facts_of_site(const SiteData& site) {
  Json facts = Json::object();
  for (const auto& [key, value] : site.metadata) facts[key] = value;
  for (const auto& [key, value] : site.peer) facts["peer's " + key] = value;
  return facts;
}

std::string clock_sentence(const TimeLine& line) {
  std::string text = "the patient's instants are laid on the surgeon's line by " + line.source;
  if (line.known) text += ", to " + fixed(seconds(line.uncertainty) * 1e3, 3) + " ms";
  return text;
}

void put(std::string& page, std::string_view place, std::string_view text) {
  const std::size_t at = page.find(place);
  if (at != std::string::npos) page.replace(at, place.size(), text);
}

/// JSON inside of a script: no text of a file ends it.
std::string harmless(const std::string& json) {
  std::string text;
  for (const char letter : json) {
    if (letter == '<') {
      text += "\\u003c";
    } else {
      text += letter;
    }
  }
  return text;
}

}  // namespace

std::string report_page(const SessionPair& session,
                        const SessionTicks& ticks,
                        const std::string& report) {
  Json data;
  data["report"] = Json::parse(report);
  data["series"]["clock"] = clock_sentence(session.time_line);
  add_curves(ticks, data["series"]);
  add_link(session, data["series"]["link"]);
  data["series"]["idle"] = Json::array();
  add_idle(ticks, data["series"]["idle"]);
  data["series"]["marks"] = Json::array();
  add_marks(session, data["series"]["marks"]);
  data["series"]["loops"] = Json::array();
  add_loops(ticks, data["series"]["loops"]);
  data["facts"]["session_id"] = session.session_id;
  data["facts"]["surgeon"] = facts_of_site(session.surgeon);
  data["facts"]["patient"] = facts_of_site(session.patient);
  std::string page{page_text("report")};
  put(page, "/*UPLOT-STYLE*/", page_text("uplot-style"));
  const std::string licence = "/*\n" + std::string{page_text("uplot-license")} + "*/\n";
  put(page, "/*UPLOT-CODE*/", licence + std::string{page_text("uplot-code")});
  put(page, "/*DATA*/", harmless(data.dump()));
  return page;
}

}  // namespace palp::review
