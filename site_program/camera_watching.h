#pragma once

#include <functional>
#include <memory>

#include "common/io/net/media_door.h"
#include "common/io/realtime/background_loop.h"
#include "monitor/camera_feed.h"
#include "site_program/camera_recording.h"
#include "site_program/status_line.h"

namespace palp::site_program {

/// The surgeon's site gets the pictures of the patient's and says what it got, on a thread and a
/// socket of its own; they go to the session file and to whoever looks at the monitor.
/// Thread: its maker's.
class CameraWatching {
 public:
  /// All outlive it. `records`: there is a session file, so pictures are wanted although nobody
  /// looks. `touch_hold`: is told how long touch is to wait for the picture; null: it does not.
  /// `arrived`: called where `feed` has one more, on the thread of the video.
  CameraWatching(bool records,
                 io::MediaDoor& door,
                 Mailbox<Duration>* touch_hold,
                 CameraRecording& recording,
                 monitor::CameraFeed& feed,
                 std::function<void()> arrived);
  ~CameraWatching();
  CameraWatching(const CameraWatching&) = delete;
  CameraWatching& operator=(const CameraWatching&) = delete;

  /// Idempotent.
  void stop();

  /// Says once what keeps pictures away for good.
  void tell_news(StatusLine& line);

 private:
  class Io;
  std::unique_ptr<Io> io_;
  std::unique_ptr<io::BackgroundLoop> loop_;
  bool told_{};
};

}  // namespace palp::site_program
