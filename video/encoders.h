#pragma once

#include <memory>

#include "video/encoder.h"

namespace palp::video {

/// H.264, constrained baseline, by OpenH264: no delay, no reordering, long-term references. Null:
/// this build has none. `width`, `height` [pixels], even. @throws std::runtime_error with one
/// sentence where the library refuses them.
[[nodiscard]] std::unique_ptr<Encoder> make_h264_encoder(int width, int height);

/// JPEG by libjpeg-turbo: each frame is a key frame, so few are all the rate allows. Null: this
/// build has none.
[[nodiscard]] std::unique_ptr<Encoder> make_jpeg_encoder(int width, int height);

}  // namespace palp::video
