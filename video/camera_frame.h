#pragma once

#include <cstdint>
#include <string>

#include "common/core/time.h"
#include "video/parity.h"

namespace palp::video {

/// A frame at the site where it is shown or recorded.
struct CameraFrame {
  TimePoint captured_at{};   ///< on this site's line
  TimePoint delivered_at{};  ///< likewise: it left, or had come; the difference is its age
  bool key{};
  bool jpeg{};
  Bytes bytes{};
};

/// How session files and live clients know it: foxglove.CompressedVideo, or CompressedImage.
struct CameraFormat {
  std::string topic;   ///< behind the site's name: "camera"
  std::string schema;  ///< full name of the message
  Bytes descriptors;   ///< FileDescriptorSet, with what it imports
};
[[nodiscard]] CameraFormat camera_format(bool jpeg);

/// The message. `stamp`: of the capture, ns since 1970.
[[nodiscard]] Bytes camera_message(const CameraFrame& frame, std::uint64_t stamp);

}  // namespace palp::video
