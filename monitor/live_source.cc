#include "monitor/live_source.h"

#include <utility>

namespace palp::monitor {

void LiveSource::publish_all(Desk& desk) {
  while (feed_.next(message_)) desk.publish(message_);
  desk.publish(feed_.status());
  desk.publish_study();
  publish_camera(desk);
}

void LiveSource::publish_camera(Desk& desk) {
  if (camera_ == nullptr) return;
  while (camera_->frames.take(frame_)) desk.publish(frame_, feed_.stamp(frame_.captured_at));
  const VideoShown& shown = camera_->shown.get();
  if (std::exchange(shown_at_, shown.at) != shown.at) desk.publish(shown, feed_.stamp(shown.at));
}

}  // namespace palp::monitor
