#pragma once

#include <memory>
#include <string_view>

#include "common/core/mailbox.h"
#include "video/camera.h"

namespace palp::patient {

/// What a camera beside the simulated phantom would see: drawn from the tip's place as the log has
/// it, and bearing that instant, so that picture and log can be held against each other.
/// Thread: that of the video.
class DrawnCamera final : public video::Camera {
 public:
  /// `tip` outlives it; its reader is this. `surface` [m]: depth of the undeformed surface.
  DrawnCamera(Mailbox<video::TipSeen>& tip, double surface) noexcept
      : tip_{tip}, surface_{surface} {}

  [[nodiscard]] int width() const noexcept override { return video::PhantomPicture::kWidth; }
  [[nodiscard]] int height() const noexcept override { return video::PhantomPicture::kHeight; }
  /// No picture where no tick has come since the last.
  [[nodiscard]] video::Shot shoot(TimePoint now) override;

 private:
  Mailbox<video::TipSeen>& tip_;  ///< writer: record, reader: video
  double surface_;                ///< [m]
  TimePoint drawn_at_{};
  video::PhantomPicture picture_;
};

/// The `captured` one, or by its name in the settings: phantom, test; null: any other. `tip` is
/// that of a phantom.
[[nodiscard]] std::unique_ptr<video::Camera> make_camera(std::unique_ptr<video::Camera> captured,
                                                         std::string_view source,
                                                         Mailbox<video::TipSeen>* tip,
                                                         double surface);

}  // namespace palp::patient
