#pragma once

#include <cstdint>

#include "common/core/device_facts.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/link/telegram.h"
#include "common/message/depth.h"
#include "common/message/map_report.h"
#include "common/record/notes.h"
#include "common/record/site_account.h"

namespace palp::patient {

/// How the site is, for its display. Written once a tick.
struct PatientStatus : record::SiteCounts {
  TimePoint at{};
  SiteState state{};
  record::NoteCode reason{};   ///< of the last change of state
  record::NoteCode refused{};  ///< why the last engagement was refused; None: it was not
  std::uint32_t epoch{};
  SiteState peer_state{};
  bool peer_heard{};
  LinkHealth link;
  DeviceFacts peer_devices;  ///< of the session's other site
  double position{};         ///< [m], tip
  double velocity{};         ///< [m/s]
  Place place{};
  double contact_force{};  ///< [N], measured
  double command{};        ///< [m], where the tip shall be
  bool gate_acted{};
  record::NoteCode place_refused{};  ///< why the tip does not follow in the plane; None: it does
  double surface{};                  ///< [m], as learned
  bool surface_known{};
  DepthEstimate depth;                   ///< newest; number 0: none yet
  MapReport map;                         ///< newest; number 0: none yet
  std::uint64_t contact_samples{};       ///< given to the estimator
  std::uint64_t contact_samples_lost{};  ///< its queue was full
};

}  // namespace palp::patient
