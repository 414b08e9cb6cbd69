#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "video/parity.h"

namespace palp::video {

/// A picture in planes of 8 bits, YUV 4:2:0 (ITU-R BT.601, full range in none: 16 to 235).
struct Picture {
  Picture() = default;
  /// Even numbers of pixels.
  Picture(int wide, int high)
      : width{wide},
        height{high},
        y(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high), 16),
        u(y.size() / 4, 128),
        v(y.size() / 4, 128) {}

  int width{};   ///< [pixels]
  int height{};  ///< [pixels]
  std::vector<std::uint8_t> y;
  std::vector<std::uint8_t> u;
  std::vector<std::uint8_t> v;
};

/// What the decoder of a frame must have, and what it keeps of it; of JPEG each is a key frame.
struct FrameNature {
  bool key{};
  bool marks{};  ///< a long-term reference: this frame's, or that of one before
  bool refers_to_long_term{};
  int frame_num{};         ///< as H.264 counts
  int marked_frame_num{};  ///< of the frame that is marked
  int key_id{};            ///< idr_pic_id of the key frame before
};

struct FrameOrder {
  double kbps{};  ///< [kbit/s], mean
  double fps{};   ///< [1/s]
  bool key{};     ///< refers to nothing
  bool soft{};    ///< with less detail, so that it is small
};

struct EncodedFrame {
  bool jpeg{};
  FrameNature nature;
  Bytes bytes;
};

/// Pictures to frames, one after the other. Thread: one.
class Encoder {
 public:
  virtual ~Encoder() = default;
  /// nullopt: this picture is left out.
  [[nodiscard]] virtual std::optional<EncodedFrame> encode(const Picture& picture,
                                                           const FrameOrder& order) = 0;
  /// The other side has this frame, which marks a long-term reference.
  virtual void acknowledge(const FrameNature& frame) = 0;
  /// The next frame is to refer to what the other side has; `held`: the newest of that.
  virtual void recover(const FrameNature& held, const FrameNature& newest) = 0;
};

}  // namespace palp::video
