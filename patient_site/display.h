#pragma once

#include <cstddef>
#include <string>

#include "patient_site/patient_status.h"

namespace palp::patient {

/// The site in one line for a terminal, without newline: state and its cue, round trip, loss, tip,
/// contact force, why the tip does not go where it is sent, depth. In `columns` (0: any) what
/// matters less is shortened or left out. Pure. Thread: the display's; allocates.
[[nodiscard]] std::string status_line(const PatientStatus& status, std::size_t columns = 0);

}  // namespace palp::patient
