#pragma once

#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/time.h"
#include "video/frame_queue.h"
#include "video/media_wire.h"

namespace palp::monitor {

/// What clients want of the camera.
struct CameraWish {
  bool watched{};        ///< somebody looks
  std::uint32_t keys{};  ///< one more: somebody needs a frame that refers to nothing
};

/// How the camera's pictures come; the counts are of the session.
struct VideoShown {
  TimePoint at{};  ///< 0: nothing is known yet
  video::VideoState state{video::VideoState::Silent};
  Duration age{};             ///< of the newest frame as it was delivered
  double kbps{};              ///< [kbit/s], of frames, in the last second
  double fps{};               ///< [1/s], likewise
  Duration standing{};        ///< of the force telegrams in queues: video yields to it
  Duration touch_held{};      ///< touch is held back for the picture so long; 0: it is not
  std::uint64_t delivered{};  ///< frames
  std::uint64_t repaired{};   ///< of these, by parity
  std::uint64_t not_shown{};  ///< lost, or without what they refer to
};

/// Between the thread of the video and the monitor's. Outlives both.
struct CameraFeed {
  video::FrameQueue frames;    ///< writer: video, reader: monitor
  Mailbox<VideoShown> shown;   ///< writer: video, reader: monitor
  Mailbox<CameraWish> wishes;  ///< writer: monitor, reader: video
};

}  // namespace palp::monitor
