#include "video/camera_frame.h"

#include <google/protobuf/descriptor.pb.h>

#include "compressed_video.pb.h"

namespace palp::video {
namespace {

constexpr std::uint64_t kBillion = 1'000'000'000;

Bytes bytes_of(const google::protobuf::MessageLite& message) {
  Bytes bytes(message.ByteSizeLong());
  (void)message.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

template <class Message>
Bytes message_of(const CameraFrame& frame, std::uint64_t stamp, const char* format) {
  Message message;
  message.mutable_timestamp()->set_seconds(static_cast<std::int64_t>(stamp / kBillion));
  message.mutable_timestamp()->set_nanos(static_cast<std::int32_t>(stamp % kBillion));
  message.set_frame_id("camera");
  message.set_data(frame.bytes.data(), frame.bytes.size());
  message.set_format(format);
  return bytes_of(message);
}

template <class Message>
CameraFormat format_of(const char* topic) {
  const google::protobuf::Descriptor* descriptor = Message::descriptor();
  google::protobuf::FileDescriptorSet set;
  google::protobuf::Timestamp::descriptor()->file()->CopyTo(set.add_file());
  descriptor->file()->CopyTo(set.add_file());
  return {.topic = topic, .schema = descriptor->full_name(), .descriptors = bytes_of(set)};
}

}  // namespace

CameraFormat camera_format(bool jpeg) {
  return jpeg ? format_of<foxglove::CompressedImage>("camera_jpeg")
              : format_of<foxglove::CompressedVideo>("camera");
}

Bytes camera_message(const CameraFrame& frame, std::uint64_t stamp) {
  return frame.jpeg ? message_of<foxglove::CompressedImage>(frame, stamp, "jpeg")
                    : message_of<foxglove::CompressedVideo>(frame, stamp, "h264");
}

}  // namespace palp::video
