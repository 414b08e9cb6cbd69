#include "video/camera_frame.h"

#include <gtest/gtest.h>

namespace palp::video {
namespace {

TEST(CameraFrameTest, IsTheMessageThatOtherToolsKnow) {
  const CameraFrame frame{
      .captured_at = {}, .key = true, .jpeg = false, .bytes = Bytes(3, std::byte{7})};
  const Bytes message = camera_message(frame, 5'000'000'002);
  // Field 1: 5 s and 2 ns; 2: "camera"; 3: the bytes; 4: "h264".
  const std::string expected{
      "\x0a\x04\x08\x05\x10\x02\x12\x06"
      "camera"
      "\x1a\x03\x07\x07\x07\x22\x04"
      "h264"};
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(message.data()), message.size()), expected);
}

TEST(CameraFrameTest, ItsFormatNamesTopicAndSchemaAndBringsWhatItImports) {
  const CameraFormat video = camera_format(false);
  EXPECT_EQ(video.topic, "camera");
  EXPECT_EQ(video.schema, "foxglove.CompressedVideo");
  const std::string set(reinterpret_cast<const char*>(video.descriptors.data()),
                        video.descriptors.size());
  EXPECT_NE(set.find("google/protobuf/timestamp.proto"), std::string::npos);
  EXPECT_EQ(camera_format(true).schema, "foxglove.CompressedImage");
}

}  // namespace
}  // namespace palp::video
