#include "video/picture.h"

#include <gtest/gtest.h>

#include "tests/video/tip_reading.h"

namespace palp::video {
namespace {

TEST(PhantomPictureTest, TheTipCanBeReadBackWhereverItIs) {
  PhantomPicture phantom;
  for (const double x : {-0.03, 0.0, 0.0123, 0.031}) {
    for (const double depth : {-0.005, 0.0, 0.0042, 0.012}) {
      const auto tip = read_tip(phantom.draw({.x = x, .depth = depth, .surface = 0}));
      ASSERT_TRUE(tip);
      EXPECT_NEAR(tip->x, x, 0.0001);
      EXPECT_NEAR(tip->depth, depth, 0.0001);
    }
  }
}

TEST(PhantomPictureTest, TheSurfaceIsPressedInBelowTheTip) {
  PhantomPicture phantom;
  const auto bright = [&](double depth) {
    const Picture& picture = phantom.draw({.x = 0, .depth = depth, .surface = 0});
    return picture.y[static_cast<std::size_t>(165) * 640 + 370];  // 6 mm aside, 0.6 mm down
  };
  EXPECT_LT(bright(0), 150) << "tissue";
  EXPECT_GT(bright(0.005), 150) << "air";
}

TEST(TestPictureTest, Moves) {
  const Picture one = test_picture(64, 48, Duration{0});
  const Picture other = test_picture(64, 48, std::chrono::milliseconds{300});
  EXPECT_NE(one.y, other.y);
}

}  // namespace
}  // namespace palp::video
