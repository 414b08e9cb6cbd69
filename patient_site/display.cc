#include "patient_site/display.h"

#include "common/core/conventions.h"
#include "common/core/depth_text.h"
#include "common/core/number_text.h"
#include "common/link/health_text.h"
#include "common/record/notes.h"

namespace palp::patient {
namespace {

std::string refusal_text(const PatientStatus& status) {
  if (status.place_refused == record::NoteCode::None) return {};
  return "(" + std::string{record::to_string(status.place_refused)} + ")  ";
}

}  // namespace

std::string status_line(const PatientStatus& status) {
  return record::state_text(status.state, status.reason, status.refused) + "  " +
         link::health_text(status.link) +
         number_text("  tip ", status.position / kMillimetre, 2, " mm") +
         number_text("  contact ", status.contact_force, 2, " N  ") + refusal_text(status) +
         depth_line_of(status.depth);
}

}  // namespace palp::patient
