#include "common/message/descriptor_builder.h"

#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

namespace palp::message {
namespace {

TEST(DescriptorBuilderTest, ProtobufReadsWhatItWrote) {
  DescriptorBuilder field;
  field.text(1, "force_n");
  field.number(3, 1900);
  DescriptorBuilder message;
  message.text(1, std::string(300, 'm'));
  message.part(2, field.bytes());
  google::protobuf::DescriptorProto read;
  ASSERT_TRUE(
      read.ParseFromArray(message.bytes().data(), static_cast<int>(message.bytes().size())));
  EXPECT_EQ(read.name(), std::string(300, 'm'));
  ASSERT_EQ(read.field_size(), 1);
  EXPECT_EQ(read.field(0).name(), "force_n");
  EXPECT_EQ(read.field(0).number(), 1900);
}

}  // namespace
}  // namespace palp::message
