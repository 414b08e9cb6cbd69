#include "patient_site/captured_camera.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include <linux/videodev2.h>

#include "common/io/process/system_text.h"

namespace palp::patient {
namespace {

constexpr std::uint32_t kBuffers = 4;
constexpr std::uint32_t kFps = 30;
constexpr std::array<std::uint32_t, 3> kFormats{
    V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_YUV420};
/// An instant of the device that lies further back is not believed.
constexpr Duration kAgeMax = std::chrono::seconds{1};

constexpr auto kWide = static_cast<std::size_t>(CapturedCamera::kWidth);
constexpr auto kHigh = static_cast<std::size_t>(CapturedCamera::kHeight);

v4l2_buffer capture_buffer(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

/// [bytes] of a picture whose first plane has rows of `row` [bytes].
std::size_t size_of(std::uint32_t format, std::size_t row) {
  return format == V4L2_PIX_FMT_YUYV ? row * kHigh : row * kHigh * 3 / 2;
}

std::uint8_t mean(std::uint8_t a, std::uint8_t b) {
  return static_cast<std::uint8_t>((unsigned{a} + unsigned{b} + 1) / 2);
}

/// Two pixels in four bytes: Y U Y V. Colour is halved in height.
void unpack_yuyv(std::span<const std::uint8_t> bytes, std::size_t row, video::Picture& to) {
  for (std::size_t j = 0; j < kHigh; ++j) {
    const auto line = bytes.subspan(j * row, 2 * kWide);
    for (std::size_t i = 0; i < kWide; ++i) to.y[j * kWide + i] = line[2 * i];
  }
  for (std::size_t j = 0; j < kHigh / 2; ++j) {
    const auto upper = bytes.subspan(2 * j * row, 2 * kWide);
    const auto lower = bytes.subspan((2 * j + 1) * row, 2 * kWide);
    for (std::size_t i = 0; i < kWide / 2; ++i) {
      to.u[j * kWide / 2 + i] = mean(upper[4 * i + 1], lower[4 * i + 1]);
      to.v[j * kWide / 2 + i] = mean(upper[4 * i + 3], lower[4 * i + 3]);
    }
  }
}

void unpack_rows(std::span<const std::uint8_t> bytes,
                 std::size_t row,
                 std::size_t wide,
                 std::vector<std::uint8_t>& to) {
  for (std::size_t j = 0; j * wide < to.size(); ++j) {
    const auto line = bytes.subspan(j * row, wide);
    std::ranges::copy(line, to.begin() + static_cast<std::ptrdiff_t>(j * wide));
  }
}

}  // namespace

Result<std::unique_ptr<CapturedCamera>> CapturedCamera::open(std::unique_ptr<io::CapturePort> port,
                                                             const std::string& name) {
  std::unique_ptr<CapturedCamera> camera{new CapturedCamera{std::move(port)}};
  if (const auto started = camera->start(); !started) {
    return fail_to_reach("camera '" + name + "': " + started.error().text);
  }
  return camera;
}

Result<std::unique_ptr<video::Camera>> open_camera(const std::string& source) {
  if (!source.starts_with('/')) return nullptr;
  return CapturedCamera::open(io::make_capture_port(source), source);
}

Result<void> CapturedCamera::start() {
  if (const int error = port_->open(); error != 0) return fail(io::system_text(error));
  v4l2_capability able{};
  if (port_->control(VIDIOC_QUERYCAP, &able) != 0) return fail("it is no video device");
  const std::uint32_t can =
      (able.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? able.device_caps : able.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0) {
    return fail("it takes no pictures, or cannot stream them");
  }
  if (auto agreed = agree_on_layout(); !agreed) return agreed;
  v4l2_streamparm pace{};
  pace.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  pace.parm.capture.timeperframe = {1, kFps};
  (void)port_->control(VIDIOC_S_PARM, &pace);  // a camera that is slower is shown as it is
  return hand_out_buffers();
}

Result<void> CapturedCamera::agree_on_layout() {
  for (const std::uint32_t format : kFormats) {
    v4l2_format wanted{};
    wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    wanted.fmt.pix.width = kWide;
    wanted.fmt.pix.height = kHigh;
    wanted.fmt.pix.pixelformat = format;
    wanted.fmt.pix.field = V4L2_FIELD_NONE;
    const int error = port_->control(VIDIOC_S_FMT, &wanted);
    if (error == EBUSY) return fail("another program has it");
    const v4l2_pix_format& got = wanted.fmt.pix;
    if (error != 0 || got.pixelformat != format || got.width != kWide || got.height != kHigh) {
      continue;
    }
    const std::size_t least = format == V4L2_PIX_FMT_YUYV ? 2 * kWide : kWide;
    const std::size_t row = std::max<std::size_t>(got.bytesperline, least);
    layout_ = {format, row, size_of(format, row)};
    return {};
  }
  return fail("it gives pictures of 640 x 480 neither in YUYV nor in NV12 nor in YU12");
}

Result<void> CapturedCamera::hand_out_buffers() {
  v4l2_requestbuffers wanted{};
  wanted.count = kBuffers;
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  wanted.memory = V4L2_MEMORY_MMAP;
  if (port_->control(VIDIOC_REQBUFS, &wanted) != 0 || wanted.count < 2) {
    return fail("it has no memory for pictures");
  }
  buffers_.clear();
  for (std::uint32_t index = 0; index < wanted.count; ++index) {
    v4l2_buffer buffer = capture_buffer(index);
    if (port_->control(VIDIOC_QUERYBUF, &buffer) != 0) return fail("it has no such buffer");
    buffers_.push_back(port_->map(buffer.length, buffer.m.offset));
    if (buffers_.back().empty()) return fail("its memory cannot be had");
    if (port_->control(VIDIOC_QBUF, &buffer) != 0) return fail("it takes no buffer");
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (port_->control(VIDIOC_STREAMON, &type) != 0) return fail("it does not start");
  return {};
}

video::Shot CapturedCamera::shoot(TimePoint now) {
  if (gone_at_) {
    if (now - *gone_at_ < kLookAgain) return {};
    gone_at_.reset();
    if (!start()) lose(now);
    return {};
  }
  // The newest; older ones go back unseen.
  std::optional<Taken> newest;
  for (std::uint32_t i = 0; i < kBuffers && !gone_at_; ++i) {
    const auto taken = take(now);
    if (!taken) break;
    if (newest) give_back(newest->index, now);
    newest = taken;
  }
  if (!newest || gone_at_) return {};
  const std::span<const std::uint8_t> bytes = buffers_[newest->index];
  const bool whole = !newest->faulty && std::min(newest->used, bytes.size()) >= layout_.size;
  if (whole) unpack(bytes);
  give_back(newest->index, now);
  if (!whole) return {};
  const TimePoint told{Duration{newest->at_ns}};
  const bool believed = newest->at_ns >= 0 && told <= now && now - told < kAgeMax;
  captured_at_ = std::max(captured_at_, believed ? told : now);
  return {.picture = &picture_, .captured_at = captured_at_};
}

std::optional<CapturedCamera::Taken> CapturedCamera::take(TimePoint now) {
  v4l2_buffer buffer = capture_buffer(0);
  const int error = port_->control(VIDIOC_DQBUF, &buffer);
  if (error == EAGAIN) return std::nullopt;
  if (error != 0 || buffer.index >= buffers_.size()) {
    lose(now);
    return std::nullopt;
  }
  Taken taken{.index = buffer.index,
              .used = buffer.bytesused,
              .faulty = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0};
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    taken.at_ns = std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 +
                  std::int64_t{buffer.timestamp.tv_usec} * 1'000;
  }
  return taken;
}

void CapturedCamera::give_back(std::uint32_t index, TimePoint now) {
  v4l2_buffer buffer = capture_buffer(index);
  if (port_->control(VIDIOC_QBUF, &buffer) != 0) lose(now);
}

void CapturedCamera::lose(TimePoint now) {
  buffers_.clear();
  port_->close();
  gone_at_ = now;
}

void CapturedCamera::unpack(std::span<const std::uint8_t> bytes) {
  const std::size_t row = layout_.row;
  if (layout_.format == V4L2_PIX_FMT_YUYV) return unpack_yuyv(bytes, row, picture_);
  unpack_rows(bytes, row, kWide, picture_.y);
  const auto colour = bytes.subspan(row * kHigh);
  if (layout_.format == V4L2_PIX_FMT_YUV420) {
    unpack_rows(colour, row / 2, kWide / 2, picture_.u);
    return unpack_rows(colour.subspan(row / 2 * kHigh / 2), row / 2, kWide / 2, picture_.v);
  }
  for (std::size_t j = 0; j < kHigh / 2; ++j) {
    const auto line = colour.subspan(j * row, kWide);
    for (std::size_t i = 0; i < kWide / 2; ++i) {
      picture_.u[j * kWide / 2 + i] = line[2 * i];
      picture_.v[j * kWide / 2 + i] = line[2 * i + 1];
    }
  }
}

}  // namespace palp::patient
