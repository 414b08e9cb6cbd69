#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "video/encoder.h"

namespace palp::video {

/// Reads of our own encoder's frames (H.264, Annex B, baseline, frames only) what they are: just
/// enough of ITU-T H.264 7.3.2.1.1, 7.3.3. A value; remembers the newest parameter set.
class H264Reading {
 public:
  /// `frame`: whole. nullopt: no slice that can be read.
  [[nodiscard]] std::optional<FrameNature> read(std::span<const std::byte> frame);

 private:
  void read_parameters(std::span<const std::byte> unit);
  [[nodiscard]] std::optional<FrameNature> read_slice(std::span<const std::byte> unit);

  unsigned frame_num_bits_{4};
  unsigned order_bits_{0};  ///< 0: the order is not counted
  int key_id_{};
};

}  // namespace palp::video
