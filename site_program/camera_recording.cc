#include "site_program/camera_recording.h"

#include <string>

namespace palp::site_program {

void CameraRecording::write_to(record::SessionWriter* writer,
                               link::Role site,
                               const record::WallClock& clock) {
  while (frames_.take(frame_)) {
    if (writer == nullptr) continue;
    std::optional<std::uint16_t>& topic = topics_[frame_.jpeg ? 1 : 0];
    if (!topic) {
      const video::CameraFormat format = video::camera_format(frame_.jpeg);
      topic = writer->add_topic({.name = std::string{record::site_name(site)} + "/" + format.topic,
                                 .schema = format.schema,
                                 .descriptors = format.descriptors});
    }
    (void)writer->write(*topic,
                        {.sample = frame_.captured_at, .logged = frame_.delivered_at},
                        video::camera_message(frame_, clock.stamp(frame_.captured_at)));
  }
}

}  // namespace palp::site_program
