#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <deque>
#include <vector>

#include <linux/videodev2.h>

#include "common/io/device/capture_port.h"

/// A video device for tests: what a driver of the kernel answers, and what breaks.
namespace palp::patient::test {

/// What happens to it; the test holds it, the camera owns the port.
struct Capture {
  std::uint32_t format{V4L2_PIX_FMT_YUYV};  ///< the one that it can do
  std::uint32_t width{640};                 ///< [pixels]
  std::uint32_t row{1280};                  ///< [bytes], bytesperline
  std::uint32_t able{V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING};
  int open_error{};
  int format_error{};
  bool plugged{true};
  bool monotonic{true};
  int opened{};  ///< so many times
  bool streams{};
  std::deque<std::uint32_t> queued{};  ///< buffers that the device has
  std::deque<v4l2_buffer> filled{};
  std::vector<std::vector<std::uint8_t>> memory{};

  /// A picture of these bytes was taken at `at_ns`. @returns whether the device had room for it.
  bool take(const std::vector<std::uint8_t>& bytes, std::int64_t at_ns, std::uint32_t flags = 0) {
    if (!streams || queued.empty()) return false;
    v4l2_buffer buffer{};
    buffer.index = queued.front();
    queued.pop_front();
    std::ranges::copy(bytes, memory[buffer.index].begin());
    buffer.bytesused = static_cast<std::uint32_t>(bytes.size());
    buffer.flags = flags | (monotonic ? V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC : 0U);
    buffer.timestamp.tv_sec = at_ns / 1'000'000'000;
    buffer.timestamp.tv_usec = at_ns % 1'000'000'000 / 1'000;
    filled.push_back(buffer);
    return true;
  }
};

class SimulatedCapture final : public io::CapturePort {
 public:
  explicit SimulatedCapture(Capture& state) : state_{state} {}

  int open() override {
    if (!state_.plugged) return ENOENT;
    ++state_.opened;
    return state_.open_error;
  }
  void close() override {
    state_.streams = false;
    state_.queued.clear();
    state_.filled.clear();
  }
  int control(std::uint64_t request, void* argument) override {
    if (!state_.plugged) return ENODEV;
    switch (request) {
      case VIDIOC_QUERYCAP:
        static_cast<v4l2_capability*>(argument)->capabilities = state_.able;
        return 0;
      case VIDIOC_S_FMT:
        return set_format(*static_cast<v4l2_format*>(argument));
      case VIDIOC_REQBUFS:
        state_.memory.assign(static_cast<v4l2_requestbuffers*>(argument)->count, {});
        for (auto& one : state_.memory) one.resize(std::size_t{state_.row} * 480 * 2);
        return 0;
      case VIDIOC_QUERYBUF:
        static_cast<v4l2_buffer*>(argument)->length =
            static_cast<std::uint32_t>(state_.memory[0].size());
        static_cast<v4l2_buffer*>(argument)->m.offset = static_cast<v4l2_buffer*>(argument)->index;
        return 0;
      case VIDIOC_QBUF:
        state_.queued.push_back(static_cast<v4l2_buffer*>(argument)->index);
        return 0;
      case VIDIOC_DQBUF:
        if (state_.filled.empty()) return EAGAIN;
        *static_cast<v4l2_buffer*>(argument) = state_.filled.front();
        state_.filled.pop_front();
        return 0;
      case VIDIOC_STREAMON:
        state_.streams = true;
        return 0;
      default:
        return ENOTTY;
    }
  }
  std::span<const std::uint8_t> map(std::size_t length, std::uint32_t offset) override {
    return std::span{state_.memory[offset]}.first(length);
  }

 private:
  /// As drivers do: what it cannot do becomes what it can.
  int set_format(v4l2_format& wanted) const {
    if (state_.format_error != 0) return state_.format_error;
    wanted.fmt.pix.pixelformat = state_.format;
    wanted.fmt.pix.width = state_.width;
    wanted.fmt.pix.bytesperline = state_.row;
    return 0;
  }

  Capture& state_;
};

}  // namespace palp::patient::test
