#include "review/report_page.h"

#include <cstddef>

#include "common/config/json.h"
#include "common/record/notes.h"
#include "review/page_texts.h"
#include "review/text.h"

namespace palp::review {
namespace {

using config::Json;

constexpr std::size_t kCurvePoints = 6000;

/// Each n-th of a list, so that about `most` are left.
std::size_t stride_for(std::size_t size, std::size_t most) { return size / most + 1; }

void add_link(const SessionPair& session, Json& to) {
  for (const char* name : {"t", "rtt", "jitter", "lost", "sent"}) to[name] = Json::array();
  const std::vector<LinkPoint>& links = session.surgeon.links;
  const std::size_t step = stride_for(links.size(), kCurvePoints);
  for (std::size_t i = 0; i < links.size(); i += step) {
    const LinkPoint& point = links[i];
    const bool measured = point.round_trip > Duration{0};
    to["t"].push_back(shown(seconds(elapsed(session.surgeon.began_at, point.at)), 1));
    to["rtt"].push_back(measured ? shown(seconds(point.round_trip), 1e-3) : Json(nullptr));
    to["jitter"].push_back(measured ? shown(seconds(point.jitter), 1e-3) : Json(nullptr));
    to["lost"].push_back(point.lost);
    to["sent"].push_back(point.accepted + point.lost);
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
                        const ReportCurves& curves,
                        const std::string& report) {
  Json data;
  data["report"] = Json::parse(report);
  data["series"]["clock"] = clock_sentence(session.time_line);
  curves.add_to(data["series"]);
  add_link(session, data["series"]["link"]);
  data["series"]["marks"] = Json::array();
  add_marks(session, data["series"]["marks"]);
  data["facts"]["session_id"] = session.session_id;
  data["facts"]["surgeon"] = facts_of_site(session.surgeon);
  data["facts"]["patient"] = facts_of_site(session.patient);
  std::string page{page_text("report")};
  put(page, "/*UPLOT-STYLE*/", page_text("uplot-style"));
  const std::string licence = "/*\n" + std::string{page_text("uplot-license")} + "*/\n";
  put(page, "/*UPLOT-CODE*/", licence + std::string{page_text("uplot-code")});
  put(page, "/*PLANE-CODE*/", page_text("plane"));
  put(page, "/*DATA*/", harmless(data.dump()));
  return page;
}

}  // namespace palp::review
