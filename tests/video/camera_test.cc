#include "video/camera.h"

#include <gtest/gtest.h>

namespace palp::video {
namespace {

TEST(CameraTest, TheTestPictureMovesAndBearsItsInstant) {
  TestCamera camera;
  const TimePoint at{std::chrono::seconds{7}};
  const Shot first = camera.shoot(at);
  ASSERT_NE(first.picture, nullptr);
  EXPECT_EQ(first.captured_at, at);
  EXPECT_EQ(first.picture->width, camera.width());
  EXPECT_EQ(first.picture->height, camera.height());
  const auto before = first.picture->y;
  EXPECT_NE(camera.shoot(at + std::chrono::milliseconds{100}).picture->y, before);
}

}  // namespace
}  // namespace palp::video
