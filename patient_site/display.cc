#include "patient_site/display.h"

#include "common/core/conventions.h"
#include "common/core/depth_text.h"
#include "common/core/number_text.h"
#include "common/link/health_text.h"
#include "common/record/notes.h"

namespace palp::patient {

std::string status_line(const PatientStatus& status) {
  return record::state_text(status.state, status.reason, status.refused) + "  " +
         health_text(status.link) + number_text("  tip ", status.position / kMillimetre, 2, " mm") +
         number_text("  contact ", status.contact_force, 2, " N  ") + depth_line_of(status.depth);
}

}  // namespace palp::patient
