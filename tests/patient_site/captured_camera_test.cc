#include "patient_site/captured_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/patient_site/simulated_capture.h"

namespace palp::patient {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr TimePoint kNow{seconds{100}};
constexpr std::int64_t kNowNs = kNow.time_since_epoch().count();
constexpr std::size_t kPixels = std::size_t{640} * 480;

std::unique_ptr<CapturedCamera> opened(test::Capture& device) {
  auto camera =
      CapturedCamera::open(std::make_unique<test::SimulatedCapture>(device), "/dev/video9");
  EXPECT_TRUE(camera) << camera.error().text;
  return std::move(*camera);
}

std::string refusal(test::Capture device) {
  const auto camera =
      CapturedCamera::open(std::make_unique<test::SimulatedCapture>(device), "/dev/video9");
  return camera ? std::string{} : camera.error().text;
}

/// The same picture in a layout: brightness falls with height, colour with width.
std::vector<std::uint8_t> laid_out(std::uint32_t format, std::size_t row) {
  const auto bright = [](std::size_t j) { return static_cast<std::uint8_t>(20 + j / 4); };
  const auto blue = [](std::size_t i) { return static_cast<std::uint8_t>(30 + i / 4); };
  const auto red = [](std::size_t i) { return static_cast<std::uint8_t>(200 - i / 4); };
  std::vector<std::uint8_t> bytes(format == V4L2_PIX_FMT_YUYV ? row * 480 : row * 720);
  for (std::size_t j = 0; j < 480; ++j) {
    for (std::size_t i = 0; i < 640; ++i) {
      if (format != V4L2_PIX_FMT_YUYV) {
        bytes[j * row + i] = bright(j);
        continue;
      }
      bytes[j * row + 2 * i] = bright(j);
      bytes[j * row + 2 * i + 1] = i % 2 == 0 ? blue(i / 2) : red(i / 2);
    }
  }
  for (std::size_t j = 0; j < 240; ++j) {
    for (std::size_t i = 0; i < 320; ++i) {
      if (format == V4L2_PIX_FMT_NV12) {
        bytes[row * 480 + j * row + 2 * i] = blue(i);
        bytes[row * 480 + j * row + 2 * i + 1] = red(i);
      } else if (format == V4L2_PIX_FMT_YUV420) {
        bytes[row * 480 + j * row / 2 + i] = blue(i);
        bytes[row * 600 + j * row / 2 + i] = red(i);
      }
    }
  }
  return bytes;
}

struct Layout {
  std::uint32_t format{};
  std::uint32_t row{};
};

class CapturedCameraLayout : public testing::TestWithParam<Layout> {};

TEST_P(CapturedCameraLayout, ShowsTheSamePictureWhateverItsLayout) {
  test::Capture device{.format = GetParam().format, .row = GetParam().row};
  const auto camera = opened(device);
  ASSERT_TRUE(device.take(laid_out(device.format, device.row), kNowNs - 20'000'000));
  const video::Shot shot = camera->shoot(kNow);
  ASSERT_NE(shot.picture, nullptr);
  EXPECT_EQ(shot.captured_at, kNow - milliseconds{20});
  for (std::size_t j = 0; j < 480; ++j) {
    ASSERT_EQ(shot.picture->y[j * 640], 20 + j / 4);
    ASSERT_EQ(shot.picture->y[j * 640 + 639], 20 + j / 4);
  }
  constexpr std::size_t kLast = std::size_t{239} * 320;
  for (std::size_t i = 0; i < 320; ++i) {
    ASSERT_EQ(shot.picture->u[kLast + i], 30 + i / 4);
    ASSERT_EQ(shot.picture->v[kLast + i], 200 - i / 4);
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts,
                         CapturedCameraLayout,
                         testing::Values(Layout{V4L2_PIX_FMT_YUYV, 1280},
                                         Layout{V4L2_PIX_FMT_YUYV, 1344},
                                         Layout{V4L2_PIX_FMT_NV12, 640},
                                         Layout{V4L2_PIX_FMT_NV12, 704},
                                         Layout{V4L2_PIX_FMT_YUV420, 640},
                                         Layout{V4L2_PIX_FMT_YUV420, 704}));

TEST(CapturedCameraTest, ShowsTheNewestAndGivesEachBufferBack) {
  test::Capture device;
  const auto camera = opened(device);
  EXPECT_EQ(camera->shoot(kNow).picture, nullptr) << "none yet";
  for (int round = 0; round < 20; ++round) {
    const TimePoint now = kNow + milliseconds{33 * round};
    for (int i = 0; i < 3; ++i) {
      std::vector<std::uint8_t> bytes(2 * kPixels, static_cast<std::uint8_t>(50 + i));
      ASSERT_TRUE(
          device.take(bytes, now.time_since_epoch().count() - std::int64_t{1'000'000} * (3 - i)));
    }
    const video::Shot shot = camera->shoot(now);
    ASSERT_NE(shot.picture, nullptr);
    EXPECT_EQ(shot.picture->y[0], 52);
    EXPECT_EQ(shot.captured_at, now - milliseconds{1});
    EXPECT_EQ(device.queued.size(), 4U);
  }
}

TEST(CapturedCameraTest, AnotherClockIsNotBelieved) {
  test::Capture device{.monotonic = false};
  const auto camera = opened(device);
  const std::vector<std::uint8_t> bytes(2 * kPixels, 60);
  ASSERT_TRUE(device.take(bytes, 5));
  EXPECT_EQ(camera->shoot(kNow).captured_at, kNow);
  device.monotonic = true;
  ASSERT_TRUE(device.take(bytes, kNowNs + 3'000'000'000)) << "of the future";
  EXPECT_EQ(camera->shoot(kNow + milliseconds{1}).captured_at, kNow + milliseconds{1});
  ASSERT_TRUE(device.take(bytes, kNowNs - 500'000'000)) << "older than the last";
  EXPECT_EQ(camera->shoot(kNow + milliseconds{2}).captured_at, kNow + milliseconds{1});
}

TEST(CapturedCameraTest, ABrokenPictureIsNotShown) {
  test::Capture device;
  const auto camera = opened(device);
  ASSERT_TRUE(device.take(std::vector<std::uint8_t>(1000, 9), kNowNs)) << "cut off";
  EXPECT_EQ(camera->shoot(kNow).picture, nullptr);
  ASSERT_TRUE(device.take(std::vector<std::uint8_t>(2 * kPixels, 9), kNowNs, V4L2_BUF_FLAG_ERROR));
  EXPECT_EQ(camera->shoot(kNow).picture, nullptr);
  EXPECT_EQ(device.queued.size(), 4U) << "and its buffer goes back";
}

TEST(CapturedCameraTest, UnpluggedItGivesNoneUntilItIsBack) {
  test::Capture device;
  const auto camera = opened(device);
  device.plugged = false;
  TimePoint now = kNow;
  for (int i = 0; i < 300; ++i, now += milliseconds{33}) {
    EXPECT_EQ(camera->shoot(now).picture, nullptr);
  }
  EXPECT_EQ(device.opened, 1) << "it is not there to be opened";
  device.plugged = true;
  const TimePoint back = now;
  while (!device.streams && now < back + seconds{5}) {
    (void)camera->shoot(now);
    now += milliseconds{33};
  }
  EXPECT_LE(now - back, CapturedCamera::kLookAgain + milliseconds{66});
  ASSERT_TRUE(
      device.take(std::vector<std::uint8_t>(2 * kPixels, 77), now.time_since_epoch().count()));
  const video::Shot shot = camera->shoot(now);
  ASSERT_NE(shot.picture, nullptr);
  EXPECT_EQ(shot.picture->y[100], 77);
}

TEST(CapturedCameraTest, WhatCannotBeUsedIsRefusedInASentence) {
  EXPECT_EQ(refusal({}), "");
  EXPECT_THAT(refusal({.plugged = false}),
              HasSubstr("camera '/dev/video9': no such file or directory"));
  EXPECT_THAT(refusal({.able = V4L2_CAP_VIDEO_OUTPUT}), HasSubstr("takes no pictures"));
  EXPECT_THAT(refusal({.format = V4L2_PIX_FMT_MJPEG}), HasSubstr("neither in YUYV nor"));
  EXPECT_THAT(refusal({.width = 320}), HasSubstr("640 x 480"));
  EXPECT_THAT(refusal({.format_error = EBUSY}), HasSubstr("another program has it"));
}

}  // namespace
}  // namespace palp::patient
