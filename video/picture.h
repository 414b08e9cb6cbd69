#pragma once

#include <cstdint>

#include "common/core/time.h"
#include "video/encoder.h"

namespace palp::video {

/// A picture and when it was taken.
struct Shot {
  const Picture* picture{};  ///< valid until the next; null: there is none now
  TimePoint captured_at{};
};

/// Pixels and millimetres of the drawn phantom: seen from the side, the undeformed surface level.
struct PictureScale {
  double pixels_per_m{8000};  ///< [pixels/m]: 640 pixels are 80 mm
  double left_edge{-0.040};   ///< [m], lateral
  double top_edge{-0.020};    ///< [m], depth: 20 mm above the surface
};

/// What a camera beside the simulated phantom would see.
struct Scene {
  double x{};        ///< [m], lateral, of the tip
  double depth{};    ///< [m], of the tip's lowest point; + into the tissue
  double surface{};  ///< [m], depth of the undeformed surface
};

/// Draws scenes: a ball on a rod, tissue with fine grain, its surface pressed in below the ball.
/// The ball alone is blue, so that its place can be read back from a decoded picture.
/// Thread: one.
class PhantomPicture {
 public:
  static constexpr int kWidth = 640;            ///< [pixels]
  static constexpr int kHeight = 480;           ///< [pixels]
  static constexpr double kBallRadius = 0.005;  ///< [m]

  PhantomPicture();
  /// Valid until the next.
  [[nodiscard]] const Picture& draw(const Scene& scene);

 private:
  void draw_tissue(const Scene& scene);
  void draw_tip(const Scene& scene);

  PictureScale scale_;
  Picture background_;  ///< grain, as if all were tissue
  Picture picture_;
};

/// Bars and a moving block: that there is a picture, and that it moves. `at`: since the session
/// began.
[[nodiscard]] Picture test_picture(int width, int height, Duration at);

}  // namespace palp::video
