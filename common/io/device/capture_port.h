#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace palp::io {

/// The calls by which a video device of the kernel (V4L2) is spoken to; tests have a device of
/// their own behind them. Thread: one at a time.
class CapturePort {
 public:
  virtual ~CapturePort() = default;

  /// Opens it without waiting for anything. @returns 0, or an errno value.
  virtual int open() = 0;
  /// Takes back all that was mapped. Idempotent.
  virtual void close() = 0;
  /// An ioctl of linux/videodev2.h; `argument` as it wants. @returns 0, or an errno value.
  virtual int control(std::uint64_t request, void* argument) = 0;
  /// Memory of the device's buffer at `offset`, until close(). Empty: it cannot be had.
  virtual std::span<const std::uint8_t> map(std::size_t length, std::uint32_t offset) = 0;
};

/// The device file `path` ("/dev/video0").
[[nodiscard]] std::unique_ptr<CapturePort> make_capture_port(std::string path);

}  // namespace palp::io
