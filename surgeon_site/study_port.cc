#include "surgeon_site/study_port.h"

#include <algorithm>
#include <cmath>

#include "common/config/json.h"
#include "common/record/notes.h"

namespace palp::surgeon {
namespace {

using config::Json;
using record::NoteCode;

constexpr double kReach = 0.25;  // [m], to all sides: half of a stage's travel

std::int64_t in_ns(TimePoint at) noexcept { return at.time_since_epoch().count(); }

/// [m], of a length in mm; nothing where it is none or lies beyond a stage's travel.
std::optional<double> length_of(const Json& value) {
  const auto mm = value.number();
  if (!mm || !(std::abs(*mm) <= 1e3 * kReach)) return std::nullopt;
  return *mm / 1e3;
}

bool is_of_a_study(double code) noexcept {
  return code >= static_cast<double>(NoteCode::StudyTrial) &&
         code <= static_cast<double>(NoteCode::StudyAnswer) && code == std::floor(code);
}

}  // namespace

void StudyPort::tell_page(const std::string& address) {
  (void)pipe_.send(Json{{"page", address}}.dump());
}

void StudyPort::tell_answer(std::uint32_t choice, TimePoint now) {
  (void)pipe_.send(Json{{"answer", choice}, {"at_ns", in_ns(now)}}.dump());
}

bool StudyPort::look(const SurgeonStatus& status,
                     site_program::Recording& recording,
                     TimePoint now) {
  while (const auto message = pipe_.receive()) obey(*message, recording, now);
  for (monitor::StudyAnswer one; screen_.answers.try_dequeue(one);) {
    (void)pipe_.send(
        Json{{"answer", one.choice}, {"trial", one.trial}, {"at_ns", in_ns(one.at)}}.dump());
  }
  const bool engaged =
      status.state == SiteState::Engaged && status.peer_state == SiteState::Engaged;
  (void)pipe_.send(Json{{"at_ns", in_ns(status.at)},
                        {"engaged", engaged},
                        {"force_n", status.force},
                        {"contact_n", status.contact_force},
                        {"x_mm", status.peer_place.x * 1e3},
                        {"y_mm", status.peer_place.y * 1e3}}
                       .dump());
  return pipe_.open();
}

void StudyPort::obey(const std::string& message,
                     site_program::Recording& recording,
                     TimePoint now) {
  const Json said = Json::parse(message);
  if (said.contains("place")) {
    const auto x = length_of(said["place"].at_or_null("x_mm"));
    const auto y = length_of(said["place"].at_or_null("y_mm"));
    const auto reach = length_of(said["place"].at_or_null("reach_mm")).value_or(0);
    if (x && y) hand_.places().put({{*x, *y}, std::max(0.0, reach), ++wishes_});
  }
  if (said.contains("show")) (void)screen_.shown.try_enqueue(said["show"].dump());
  const auto code = said.at_or_null("note").number();
  const auto detail = said.at_or_null("detail").number();
  if (!code || !detail || !is_of_a_study(*code)) return;
  const auto at = said.at_or_null("at_ns").number();
  const TimePoint when = at ? TimePoint{Duration{static_cast<std::int64_t>(*at)}} : now;
  recording.note(static_cast<NoteCode>(*code), *detail, when);
}

}  // namespace palp::surgeon
