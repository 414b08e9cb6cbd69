#pragma once

#include "common/core/spsc_queue.h"
#include "video/camera_frame.h"

namespace palp::video {

/// Frames from the thread of the video to another, bounded. Where one does not fit, those that rest
/// on it are of no use either: nothing more is taken until a key frame comes.
class FrameQueue {
 public:
  /// Thread: the video's. @returns false: left out, a key frame is needed.
  bool offer(const CameraFrame& frame) {
    if (broken_ && !frame.key) return false;
    broken_ = !queue_.try_enqueue(frame);
    return !broken_;
  }
  /// Thread: the reader's. false: no more.
  [[nodiscard]] bool take(CameraFrame& frame) { return queue_.try_dequeue(frame); }

 private:
  static constexpr std::size_t kFramesMax = 64;  ///< 2 s of them

  SpscQueue<CameraFrame> queue_{kFramesMax};
  bool broken_{true};
};

}  // namespace palp::video
