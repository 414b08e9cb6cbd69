#include "patient_site/display.h"

#include <array>

#include "common/core/conventions.h"
#include "common/core/depth_text.h"
#include "common/core/fitted_line.h"
#include "common/core/number_text.h"
#include "common/link/health_text.h"
#include "common/message/map_text.h"
#include "common/record/notes.h"

namespace palp::patient {
namespace {

std::string refusal_text(const PatientStatus& status) {
  if (status.place_refused == record::NoteCode::None) return {};
  return "(" + std::string{record::to_string(status.place_refused)} + ")";
}

/// Touches at several places say more than the last one alone.
LinePart found_part(const PatientStatus& status) {
  if (status.map.number != 0) {
    return {.full = map_line(status.map), .brief = map_brief(status.map), .rank = 2};
  }
  return {.full = depth_line_of(status.depth), .brief = depth_brief_of(status.depth), .rank = 2};
}

}  // namespace

std::string status_line(const PatientStatus& status, std::size_t columns) {
  const std::string tip = number_text("tip ", status.position / kMillimetre, 2, " mm");
  const std::string contact = number_text("contact ", status.contact_force, 2, " N");
  std::array<LinePart, 6> parts{
      {{.full = record::state_text(status.state, status.reason, status.refused),
        .brief = std::string{to_string(status.state)},
        .rank = 4},
       {.full = link::health_text(status.link),
        .brief = link::health_brief(status.link),
        .rank = 1},
       {.full = tip, .brief = tip, .rank = 5},
       {.full = contact, .brief = contact, .rank = 5},
       {.full = refusal_text(status), .brief = {}, .rank = 3},
       found_part(status)}};
  return fitted_line(parts, columns);
}

}  // namespace palp::patient
