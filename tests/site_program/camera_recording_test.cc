#include "site_program/camera_recording.h"

#include <gtest/gtest.h>

#include "common/record/session_reader.h"

namespace palp::site_program {
namespace {

record::SessionInfo patient() {
  record::SessionInfo info;
  info.site = link::Role::Patient;
  return info;
}

TEST(CameraRecordingTest, FramesAreInTheFileWithTheirInstant) {
  record::MemorySink sink;
  CameraRecording camera;
  const TimePoint at{std::chrono::seconds{3}};
  {
    record::SessionWriter writer{sink, patient()};
    (void)camera.frames().offer({.captured_at = at, .key = true, .bytes = {std::byte{7}}});
    (void)camera.frames().offer({.captured_at = at + std::chrono::seconds{1}, .key = false});
    camera.write_to(&writer, link::Role::Patient, {});
    EXPECT_EQ(writer.counts().foreign, 2U);
    EXPECT_EQ(writer.counts().messages(), writer.messages());
  }
  record::SessionReader reader{sink.bytes()};
  while (reader.next()) {
  }
  ASSERT_EQ(reader.topics().count("patient/camera"), 1U);
  const record::TopicCount& topic = reader.topics().at("patient/camera");
  EXPECT_EQ(topic.messages, 2U);
  EXPECT_EQ(topic.schema, "foxglove.CompressedVideo");
  EXPECT_EQ(topic.first, at);
  EXPECT_EQ(reader.unknown(), 0U) << "a reader knows what they are";
}

TEST(CameraRecordingTest, ANewFileHasItsTopicToo) {
  CameraRecording camera;
  for (int file = 0; file < 2; ++file) {
    record::MemorySink sink;
    {
      record::SessionWriter writer{sink, patient()};
      camera.begin_file();
      (void)camera.frames().offer({.key = true, .jpeg = true});
      camera.write_to(&writer, link::Role::Patient, {});
    }
    record::SessionReader reader{sink.bytes()};
    while (reader.next()) {
    }
    EXPECT_EQ(reader.topics().count("patient/camera_jpeg"), 1U);
  }
}

TEST(CameraRecordingTest, WithoutAFileFramesDoNotPileUp) {
  CameraRecording camera;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(camera.frames().offer({.key = i == 0}));
    camera.write_to(nullptr, link::Role::Patient, {});
  }
}

}  // namespace
}  // namespace palp::site_program
