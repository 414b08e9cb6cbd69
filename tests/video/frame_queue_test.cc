#include "video/frame_queue.h"

#include <gtest/gtest.h>

namespace palp::video {
namespace {

CameraFrame frame(bool key) { return {.key = key, .bytes = {std::byte{1}}}; }

TEST(FrameQueueTest, BeginsWithAKeyFrame) {
  FrameQueue queue;
  EXPECT_FALSE(queue.offer(frame(false)));
  EXPECT_TRUE(queue.offer(frame(true)));
  EXPECT_TRUE(queue.offer(frame(false)));
  CameraFrame taken;
  EXPECT_TRUE(queue.take(taken));
  EXPECT_TRUE(taken.key);
  EXPECT_TRUE(queue.take(taken));
  EXPECT_FALSE(queue.take(taken));
}

TEST(FrameQueueTest, WhatRestsOnAFrameThatDidNotFitIsLeftOutToo) {
  FrameQueue queue;
  ASSERT_TRUE(queue.offer(frame(true)));
  int taken_in = 0;
  while (taken_in < 1000 && queue.offer(frame(false))) ++taken_in;
  ASSERT_LT(taken_in, 1000) << "it has no bound";
  CameraFrame taken;
  while (queue.take(taken)) {
  }
  EXPECT_FALSE(queue.offer(frame(false))) << "there is room, but its reference is missing";
  EXPECT_TRUE(queue.offer(frame(true)));
  EXPECT_TRUE(queue.offer(frame(false)));
}

}  // namespace
}  // namespace palp::video
