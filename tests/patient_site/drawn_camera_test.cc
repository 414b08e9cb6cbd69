#include "patient_site/drawn_camera.h"

#include <gtest/gtest.h>

#include "tests/video/tip_reading.h"

namespace palp::patient {
namespace {

constexpr TimePoint kAt{std::chrono::seconds{5}};

TEST(DrawnCameraTest, ShowsTheTipWhereTheLogHasItAndBearsThatInstant) {
  Mailbox<video::TipSeen> tip;
  DrawnCamera camera{tip, 0.001};
  for (const double depth : {-0.004, 0.0, 0.0083}) {
    for (const double x : {-0.02, 0.0125}) {
      static int number = 0;
      const TimePoint at = kAt + std::chrono::milliseconds{++number};
      tip.put({.at = at, .x = x, .depth = depth});
      const video::Shot shot = camera.shoot(at + std::chrono::milliseconds{9});
      ASSERT_NE(shot.picture, nullptr);
      EXPECT_EQ(shot.captured_at, at);
      const auto read = video::read_tip(*shot.picture);
      ASSERT_TRUE(read);
      EXPECT_NEAR(read->x, x, 1e-4);
      EXPECT_NEAR(read->depth, depth, 1e-4);
    }
  }
}

TEST(DrawnCameraTest, WhereNoTickHasComeThereIsNoPicture) {
  Mailbox<video::TipSeen> tip;
  DrawnCamera camera{tip, 0};
  EXPECT_EQ(camera.shoot(kAt).picture, nullptr);
  tip.put({.at = kAt});
  EXPECT_NE(camera.shoot(kAt).picture, nullptr);
  EXPECT_EQ(camera.shoot(kAt).picture, nullptr) << "it is the same as before";
}

}  // namespace
}  // namespace palp::patient
