#pragma once

#include "common/record/session_writer.h"
#include "patient_site/phantom.h"

namespace palp::patient {

/// The truth about the tissue, into a session file, for whoever judges the session afterwards.
/// `surface_offset` [m].
void describe_tissue(const Phantom& phantom, double surface_offset, record::SessionInfo& info);

}  // namespace palp::patient
