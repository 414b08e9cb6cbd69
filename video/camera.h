#pragma once

#include "common/core/time.h"
#include "video/encoder.h"
#include "video/picture.h"

namespace palp::video {

/// Where pictures come from. Thread: that of the video.
class Camera {
 public:
  virtual ~Camera() = default;
  [[nodiscard]] virtual int width() const noexcept = 0;   ///< [pixels], even
  [[nodiscard]] virtual int height() const noexcept = 0;  ///< [pixels], even
  /// The newest picture, 30 times a second; its time is at most `now` and never falls.
  [[nodiscard]] virtual Shot shoot(TimePoint now) = 0;
};

/// Bars and a moving block: that there is a picture, and that it moves.
class TestCamera final : public Camera {
 public:
  [[nodiscard]] int width() const noexcept override { return kWidth; }
  [[nodiscard]] int height() const noexcept override { return kHeight; }
  [[nodiscard]] Shot shoot(TimePoint now) override {
    picture_ = test_picture(kWidth, kHeight, now.time_since_epoch());
    return {.picture = &picture_, .captured_at = now};
  }

 private:
  static constexpr int kWidth = 640;
  static constexpr int kHeight = 480;
  Picture picture_;
};

/// A tip as the log has it.
struct TipSeen {
  TimePoint at{};  ///< 0: none yet
  double x{};      ///< [m], lateral
  double depth{};  ///< [m], of the lowest point; + into the tissue
};

}  // namespace palp::video
