#pragma once

#include <cstdint>
#include <type_traits>

#include "common/core/device_facts.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/link/telegram.h"
#include "common/record/notes.h"
#include "common/record/site_account.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

/// What people are shown of the site: a copy per tick, crosses to the display's thread by mailbox.
struct SurgeonStatus : record::SiteCounts {
  TimePoint at{};
  SiteState state{};
  record::NoteCode reason{};  ///< of the last change of state
  std::uint32_t epoch{};
  SiteState peer_state{};
  bool peer_heard{};
  LinkHealth link;
  DeviceFacts peer_devices;  ///< of the session's other site
  double position{};         ///< [m], hand, as given to the law
  Place place{};
  double offset{};  ///< [m], clutch: hand minus tip at the last engagement
  double tip{};     ///< [m], as last heard
  bool tip_known{};
  Place peer_place;        ///< of the stage, as last heard
  double force{};          ///< [N], to the hand
  double contact_force{};  ///< [N], as last heard
  bool gate_acted{};
  double force_missing{};  ///< [N], of the believed tissue's force, what the law cannot give
  /// Why the hand feels less than the tissue, so much and for so long that the surgeon is told;
  /// None: it feels all of it.
  record::NoteCode shortage{};
  double short_by{};  ///< [N], 0 where nobody can say
  DepthReport depth;
  MapReport map;  ///< as last heard; number 0: none yet
  ScriptProgress script;
  record::NoteCode refused{};  ///< why the last press of the pedal did not engage; None: it did
};
static_assert(std::is_trivially_copyable_v<SurgeonStatus>, "crosses threads by copy");

}  // namespace palp::surgeon
