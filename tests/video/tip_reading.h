#pragma once

#include <optional>

#include "video/picture.h"

namespace palp::video {

struct TipInPicture {
  double x{};      ///< [m]
  double depth{};  ///< [m], of its lowest point
};

/// Where the blue ball of a drawn phantom is: the middle of all that is blue.
[[nodiscard]] inline std::optional<TipInPicture> read_tip(const Picture& picture,
                                                          std::size_t stride_uv = 0) {
  const PictureScale scale;
  const std::size_t stride =
      stride_uv > 0 ? stride_uv : static_cast<std::size_t>(picture.width / 2);
  double count = 0;
  double across = 0;
  double down = 0;
  for (int y = 0; y < picture.height / 2; ++y) {
    for (int x = 0; x < picture.width / 2; ++x) {
      if (picture.u[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)] < 156)
        continue;
      count += 1;
      across += 2 * x + 1;
      down += 2 * y + 1;
    }
  }
  if (count < 100) return std::nullopt;
  return TipInPicture{
      .x = scale.left_edge + across / count / scale.pixels_per_m,
      .depth = scale.top_edge + down / count / scale.pixels_per_m + PhantomPicture::kBallRadius};
}

}  // namespace palp::video
