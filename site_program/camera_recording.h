#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/record/session_writer.h"
#include "site_program/force_watch.h"
#include "video/frame_queue.h"

namespace palp::site_program {

/// What the record thread and that of the video have to do with each other: frames go to the
/// session file, and what the records say of force comes back. Thread: record, but for what says
/// otherwise.
class CameraRecording {
 public:
  /// Thread: video.
  [[nodiscard]] video::FrameQueue& frames() noexcept { return frames_; }
  [[nodiscard]] ForceWatch& force() noexcept { return force_; }

  /// Another file: it knows none of the topics yet.
  void begin_file() noexcept { topics_ = {}; }
  /// Frames that wait, to the file; null: there is none.
  void write_to(record::SessionWriter* writer, link::Role site, const record::WallClock& clock);

 private:
  video::FrameQueue frames_;  ///< writer: video, reader: record
  ForceWatch force_;
  std::array<std::optional<std::uint16_t>, 2> topics_{};  ///< of H.264, of JPEG
  video::CameraFrame frame_;
};

}  // namespace palp::site_program
