#include "patient_site/display.h"

#include <string_view>

#include "common/core/conventions.h"
#include "common/core/depth_text.h"
#include "common/core/number_text.h"
#include "common/link/health_text.h"
#include "common/record/notes.h"

namespace palp::patient {
namespace {

/// What people should know about the state, where it is not the usual one.
std::string cue(const PatientStatus& status) {
  switch (status.state) {
    case SiteState::Hold:
    case SiteState::Retract:
    case SiteState::Stopped:
      return " (" + std::string{record::to_string(status.reason)} + ")";
    case SiteState::Clutched:
      if (status.refused == record::NoteCode::None) return {};
      return " (" + std::string{record::to_string(status.refused)} + ")";
    case SiteState::Parked:
    case SiteState::Engaged:
      break;
  }
  return {};
}

}  // namespace

std::string status_line(const PatientStatus& status) {
  return std::string{to_string(status.state)} + cue(status) + "  " + health_text(status.link) +
         number_text("  tip ", status.position / kMillimetre, 2, " mm") +
         number_text("  contact ", status.contact_force, 2, " N  ") + depth_line_of(status.depth);
}

}  // namespace palp::patient
