#include "video/sender.h"

#include <gtest/gtest.h>

#include "tests/video/model_encoder.h"

namespace palp::video {
namespace {

using std::chrono::milliseconds;

struct Rig {
  ModelEncoder encoder{1};
  Sender sender{{}, encoder};
  Picture picture;
  TimePoint now{};

  void frame() {
    now += RateControl::kFramePeriod;
    if (sender.wants_picture(now)) sender.take(picture, now.time_since_epoch(), now);
  }
  std::vector<Fragment> leave(Duration span = milliseconds{60}) {
    std::vector<Fragment> left;
    for (TimePoint at = now; at < now + span; at += milliseconds{1}) {
      if (const auto payload = sender.next(at)) {
        kept.push_back(*payload);
        left.push_back(std::get<Fragment>(read_media(kept.back()).value()));
      }
    }
    return left;
  }
  std::vector<Bytes> kept;
};

TEST(SenderTest, TheFirstFrameRefersToNothingAndIsSmall) {
  Rig rig;
  rig.frame();
  const auto left = rig.leave(milliseconds{200});
  ASSERT_FALSE(left.empty());
  EXPECT_TRUE(left[0].key);
  EXPECT_LE(left[0].size, 8000U);
  EXPECT_EQ(left.size(), left[0].data_count + left[0].parity_count);
}

TEST(SenderTest, NoTwoFragmentsLeaveWithinAMillisecond) {
  Rig rig;
  rig.frame();
  TimePoint before{TimePoint::min()};
  for (TimePoint at = rig.now; at < rig.now + milliseconds{80};
       at += std::chrono::microseconds{100}) {
    if (!rig.sender.next(at)) continue;
    const Duration gap = before == TimePoint::min() ? milliseconds{1} : at - before;
    EXPECT_GE(gap, milliseconds{1});
    before = at;
  }
}

TEST(SenderTest, NobodyWhoLooksGetsNothing) {
  Rig rig;
  rig.frame();
  rig.sender.hear({.unwatched = true}, {}, rig.now);
  for (int i = 0; i < 10; ++i) rig.frame();
  EXPECT_EQ(rig.sender.counts().frames, 1U);
  rig.sender.hear({.wants_key = true}, {}, rig.now);
  for (int i = 0; i < 4; ++i) rig.frame();
  EXPECT_GT(rig.sender.counts().frames, 1U);
}

TEST(SenderTest, KeyFramesAreTwoSecondsApartHoweverOftenTheyAreAskedFor) {
  Rig rig;
  for (int i = 0; i < 150; ++i) {  // 5 s
    rig.frame();
    rig.sender.hear({.wants_key = true}, {}, rig.now);
    while (rig.sender.next(rig.now)) {
    }
    (void)rig.leave();
  }
  EXPECT_GE(rig.sender.counts().keys, 2U);
  EXPECT_LE(rig.sender.counts().keys, 3U);
}

TEST(SenderTest, ALossIsMendedByALongTermReferenceNotByAKeyFrame) {
  Rig rig;
  for (std::uint32_t i = 0; i < 60; ++i) {
    rig.frame();
    (void)rig.leave();
    const auto frames = rig.sender.counts().frames;
    if (frames > 0) {
      rig.sender.hear(
          {.newest_delivered = static_cast<std::uint32_t>(frames - 1), .delivered_before = 1},
          {},
          rig.now);
    }
  }
  const auto held = static_cast<std::uint32_t>(rig.sender.counts().frames - 1);
  rig.frame();
  rig.frame();
  (void)rig.leave();
  rig.sender.hear(
      {.wants_recovery = true, .newest_delivered = held, .delivered_before = 1}, {}, rig.now);
  std::vector<Fragment> left;
  for (int i = 0; i < 4 && left.empty(); ++i) {
    rig.frame();
    left = rig.leave();
  }
  ASSERT_FALSE(left.empty());
  EXPECT_FALSE(left.back().key);
  EXPECT_GT(left.back().refers_back, 1U);
  EXPECT_EQ(rig.sender.counts().keys, 1U);
  EXPECT_EQ(rig.sender.counts().recoveries, 1U);
}

TEST(SenderTest, AReportOfWhatWasNeverSentIsNotBelieved) {
  Rig rig;
  rig.frame();
  rig.sender.hear({.unwatched = true, .newest_delivered = 500, .delivered_before = 1}, {}, rig.now);
  for (int i = 0; i < 10; ++i) rig.frame();
  EXPECT_GT(rig.sender.counts().frames, 1U);
}

}  // namespace
}  // namespace palp::video
