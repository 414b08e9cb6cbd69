// Goal: pictures cross from one site to the other beside force, and where none does it is said why.
// Method: both threads of the video, real servers and links on loopback.
#include "site_program/camera_watching.h"

#include "tests/site_program/camera_rig.h"
#include "video/touch_hold.h"

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;
using video::VideoState;

class CameraWatchingTest : public testing::Test {
 protected:
  void begin(bool records) {
    sending_.emplace(CameraSendingConfig{}, rig_.camera, rig_.patient.door, rig_.patient.recording);
    rig_.meet();
    watching_.emplace(
        records, rig_.surgeon->door, &touch_hold_, rig_.surgeon->recording, rig_.feed, [this] {
          ++arrived_;
        });
  }
  bool shown(VideoState state) {
    return rig_.run_until([&] {
      return rig_.feed.shown.get().at != TimePoint{} && rig_.feed.shown.get().state == state;
    });
  }
  test::CameraRig rig_;
  std::atomic<int> arrived_{};
  Mailbox<Duration> touch_hold_;
  std::optional<CameraSending> sending_;
  std::optional<CameraWatching> watching_;
};

TEST_F(CameraWatchingTest, PicturesComeInOrderFromAKeyFrameOn) {
  begin(true);
  std::vector<video::CameraFrame> frames;
  ASSERT_TRUE(rig_.run_until([&] {
    for (video::CameraFrame one; rig_.take(one);) frames.push_back(one);
    return frames.size() >= 20;
  }));
  EXPECT_TRUE(frames[0].key);
  EXPECT_GE(arrived_, 20);
  const TimePoint now = io::SteadyClock{}.now();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(frames[i - 1].captured_at, frames[i].captured_at);
    EXPECT_GT(frames[i].captured_at, now - std::chrono::seconds{20});
    EXPECT_LE(frames[i].captured_at, now);
  }
  EXPECT_TRUE(shown(VideoState::Sending));
  EXPECT_TRUE(rig_.run_until([&] { return rig_.feed.shown.get().delivered >= 20; }));
}

TEST_F(CameraWatchingTest, TouchIsToldToWaitForPicturesAndNoLongerWhereNoneCome) {
  begin(true);
  ASSERT_TRUE(rig_.run_until([&] { return touch_hold_.get() > Duration{0}; }));
  EXPECT_LE(touch_hold_.get(), video::TouchHold::kMax);
  EXPECT_TRUE(rig_.run_until([&] { return rig_.feed.shown.get().touch_held > Duration{0}; }));
  rig_.camera.plugged = false;
  EXPECT_TRUE(rig_.run_until([&] { return touch_hold_.get() == Duration{0}; }));
}

TEST_F(CameraWatchingTest, WhereNobodyLooksNothingIsEncoded) {
  begin(false);
  ASSERT_TRUE(shown(VideoState::Silent));
  const TimePoint until = io::SteadyClock{}.now() + milliseconds{1500};
  ASSERT_TRUE(rig_.run_until([&] { return io::SteadyClock{}.now() > until; }));
  const int before = rig_.camera.asked;
  EXPECT_LE(before, 40) << "before the first report said so";
  rig_.feed.wishes.put({.watched = true, .keys = 1});
  EXPECT_TRUE(shown(VideoState::Sending));
  EXPECT_TRUE(rig_.run_until([&] { return rig_.camera.asked > before; }));
}

TEST_F(CameraWatchingTest, AnUnpluggedCameraIsTold) {
  begin(true);
  ASSERT_TRUE(shown(VideoState::Sending));
  rig_.camera.plugged = false;
  EXPECT_TRUE(shown(VideoState::NoCamera));
  rig_.camera.plugged = true;
  EXPECT_TRUE(shown(VideoState::Sending));
}

TEST_F(CameraWatchingTest, ASiteThatSendsNoMoreIsSilent) {
  begin(true);
  ASSERT_TRUE(shown(VideoState::Sending));
  sending_.reset();
  EXPECT_TRUE(shown(VideoState::Silent));
}

TEST_F(CameraWatchingTest, AKeyFrameComesWhenOneIsAskedFor) {
  begin(true);
  video::CameraFrame frame;
  ASSERT_TRUE(rig_.run_until([&] { return rig_.take(frame); }));
  ASSERT_TRUE(rig_.run_until([&] { return rig_.take(frame) && !frame.key; }));
  rig_.feed.wishes.put({.watched = true, .keys = 1});
  EXPECT_TRUE(rig_.run_until([&] { return rig_.take(frame) && frame.key; }));
}

}  // namespace
}  // namespace palp::site_program
