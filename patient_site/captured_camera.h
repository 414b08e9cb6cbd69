#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/io/device/capture_port.h"
#include "video/camera.h"

namespace palp::patient {

/// A camera at a video device of the kernel (V4L2), 640 x 480 in YUYV, NV12 or YU12. Where it is
/// unplugged there are no pictures until it is back; it is looked for every 2 s.
/// Thread: that of the video; it waits for nothing but the opening.
class CapturedCamera final : public video::Camera {
 public:
  static constexpr int kWidth = 640;                               ///< [pixels]
  static constexpr int kHeight = 480;                              ///< [pixels]
  static constexpr Duration kLookAgain = std::chrono::seconds{2};  ///< where it went away

  /// Opens it and sees that it can do what is asked. `name`: for the sentence ("/dev/video0").
  [[nodiscard]] static Result<std::unique_ptr<CapturedCamera>> open(
      std::unique_ptr<io::CapturePort> port, const std::string& name);
  ~CapturedCamera() override { port_->close(); }
  CapturedCamera(const CapturedCamera&) = delete;
  CapturedCamera& operator=(const CapturedCamera&) = delete;

  [[nodiscard]] int width() const noexcept override { return kWidth; }
  [[nodiscard]] int height() const noexcept override { return kHeight; }
  /// The newest picture that the device has; null: none since the last.
  [[nodiscard]] video::Shot shoot(TimePoint now) override;

 private:
  /// How the bytes of a picture lie.
  struct Layout {
    std::uint32_t format{};  ///< a FourCC of V4L2
    std::size_t row{};       ///< [bytes], of the first plane
    std::size_t size{};      ///< [bytes], of a picture
  };
  /// A buffer that was taken from the device, and must go back.
  struct Taken {
    std::uint32_t index{};
    std::size_t used{};      ///< [bytes]
    bool faulty{};           ///< the device says so
    std::int64_t at_ns{-1};  ///< of the kernel's monotonic clock; -1: the device has another
  };

  explicit CapturedCamera(std::unique_ptr<io::CapturePort> port) : port_{std::move(port)} {}

  /// Up to pictures flowing; a sentence's end where it fails.
  [[nodiscard]] Result<void> start();
  [[nodiscard]] Result<void> agree_on_layout();
  [[nodiscard]] Result<void> hand_out_buffers();
  [[nodiscard]] std::optional<Taken> take(TimePoint now);
  void give_back(std::uint32_t index, TimePoint now);
  void lose(TimePoint now);
  void unpack(std::span<const std::uint8_t> bytes);

  std::unique_ptr<io::CapturePort> port_;
  Layout layout_;
  std::vector<std::span<const std::uint8_t>> buffers_;
  std::optional<TimePoint> gone_at_;  ///< nothing: pictures flow
  TimePoint captured_at_{};           ///< of the last picture
  video::Picture picture_{kWidth, kHeight};
};

/// The camera of the settings, where it is a device's file; null: it is another, or none.
[[nodiscard]] Result<std::unique_ptr<video::Camera>> open_camera(const std::string& source);

}  // namespace palp::patient
