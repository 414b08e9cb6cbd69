#pragma once

#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/pointer_report.h"
#include "common/core/spsc_queue.h"
#include "monitor/camera_feed.h"
#include "monitor/study_screen.h"

namespace palp::monitor {

/// What clients ask of the site's program. Each is a note in the session file.
struct Request {
  enum class Kind : std::uint8_t { Mark, Stop, Reset, End, PilotTook, PilotGave };
  Kind kind{};
  std::uint32_t client{};  ///< 1, 2, ... of this run
};

/// The ways from the clients to the site. Null: this site has none. The writer of all is the
/// monitor's thread. They outlive it.
struct Controls {
  SpscQueue<Request>* requests{};     ///< reader: main
  Mailbox<std::uint32_t>* stops{};    ///< reader: rt; one more: stop now
  Mailbox<PointerReport>* pointer{};  ///< reader: rt
  CameraFeed* camera{};               ///< pictures, and who wants them
  StudyScreen* study{};               ///< what a participant is shown, and answers; reader: main
};

}  // namespace palp::monitor
