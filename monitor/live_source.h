#pragma once

#include "monitor/camera_feed.h"
#include "monitor/desk.h"
#include "monitor/feed.h"

namespace palp::monitor {

/// Hands out what is new of all that clients may see. Thread: monitor.
class LiveSource {
 public:
  /// Both outlive it. `camera` null: there are no pictures.
  LiveSource(Feed& feed, CameraFeed* camera) noexcept : feed_{feed}, camera_{camera} {}

  void publish_all(Desk& desk);
  /// The pictures alone: they do not wait.
  void publish_camera(Desk& desk);

 private:
  Feed& feed_;
  CameraFeed* camera_;
  LiveMessage message_;
  video::CameraFrame frame_;
  TimePoint shown_at_{};  ///< what was told of the video last
};

}  // namespace palp::monitor
