// Goal: bytes of the log as protobuf has them, both ways. The wire's: tests/common/link.
#include <string>
#include <vector>

#include <google/protobuf/unknown_field_set.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/message/log_bytes.h"
#include "common/message/log_schema.h"
#include "proto/session_log.pb.h"
#include "tests/common/message/all_structs.h"
#include "tests/common/message/by_protobuf.h"
#include "tests/common/message/draw.h"

namespace palp::message {
namespace {

using Bytes = std::vector<std::byte>;
using google::protobuf::DescriptorPool;
using google::protobuf::Message;
using google::protobuf::MessageFactory;

std::unique_ptr<Message> message_of(std::string_view name) {
  (void)session::SurgeonTick::descriptor();  // else the linker leaves the schema out
  const auto* type = DescriptorPool::generated_pool()->FindMessageTypeByName(
      std::string{kLogPackage} + "." + std::string{name});
  return std::unique_ptr<Message>{MessageFactory::generated_factory()->GetPrototype(type)->New()};
}

template <class Struct>
Bytes written(const Struct& of) {
  std::array<std::byte, kLogMessageSizeMax> room{};
  const std::size_t size = write_log(of, room);
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
}

std::span<const std::byte> view(const std::string& bytes) {
  return std::as_bytes(std::span{bytes});
}

RC_GTEST_PROP(LogBytesTest, ProtobufReadsWhatIsWrittenAndWritesWhatIsRead, (std::uint64_t seed)) {
  each_log_message([&]<class Struct>() {
    const auto drawn_struct = drawn<Form::Log, Struct>(seed);
    for (const bool of_patient : {false, true}) {
      if (!in_file_of<Struct>(of_patient)) continue;
      const auto expected = message_of(log_name<Struct>(of_patient));
      to_protobuf(drawn_struct, *expected, of_patient);

      const Bytes bytes = written(drawn_struct);
      const auto theirs = message_of(log_name<Struct>(of_patient));
      RC_ASSERT(theirs->ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
      RC_ASSERT(theirs->GetReflection()->GetUnknownFields(*theirs).empty());
      const std::string by_protobuf = expected->SerializeAsString();
      RC_ASSERT(theirs->SerializeAsString() == by_protobuf);
      RC_ASSERT(bytes.size() == by_protobuf.size());

      Struct ours{};
      RC_ASSERT(read_log(view(by_protobuf), ours));
      RC_ASSERT(in_log_range(ours));
      RC_ASSERT(written(ours) == written(drawn_struct));
      Struct again{};
      RC_ASSERT(read_log(bytes, again));
      RC_ASSERT(written(again) == written(drawn_struct));
    }
  });
}

RC_GTEST_PROP(LogBytesTest, ReadsSpoiledBytesAsProtobufDoes, (std::uint64_t seed)) {
  Draw draw{seed + 1};
  each_log_message([&]<class Struct>() {
    Bytes bytes = written(drawn<Form::Log, Struct>(seed));
    const std::uint64_t spoils = 1 + draw.below(4);
    for (std::uint64_t i = 0; i < spoils && !bytes.empty(); ++i) {
      const std::size_t at = draw.below(bytes.size());
      const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
      switch (draw.below(4)) {
        case 0:
          bytes[at] ^= static_cast<std::byte>(1U << draw.below(8));
          break;
        case 1:
          bytes.insert(place, static_cast<std::byte>(draw.below(128)));
          break;
        case 2:
          bytes.erase(place);
          break;
        default:
          bytes.resize(at + 1);
      }
    }
    constexpr bool kOfPatient = !in_file_of<Struct>(false);
    const auto theirs = message_of(log_name<Struct>(kOfPatient));
    const bool read_by_them = theirs->ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
    Struct ours{};
    const bool read_by_us = read_log(bytes, ours);
    if (!read_by_them) return RC_ASSERT(!read_by_us);
    if (!read_by_us) return;  // a tag in more bytes than it needs, a code above 65535
    Struct expected{};
    from_protobuf(*theirs, expected, kOfPatient);
    if constexpr (requires { ours.text; }) expected.text = ours.text;
    RC_ASSERT(written(ours) == written(expected));
  });
}

TEST(LogBytesTest, SkipsWhatItDoesNotKnowWhateverItsType) {
  const std::string known{"\x08\x02", 2};  // PatientTick { state }
  for (const std::string& unknown : {std::string{"\xC0\x3E\x07", 3},
                                     std::string{"\xC1\x3E\x01\x02\x03\x04\x05\x06\x07\x08", 10},
                                     std::string{"\xC2\x3E\x02xx", 5},
                                     std::string{"\xC5\x3E\x01\x02\x03\x04", 6},
                                     std::string{"\xC3\x3E\x08\x01\xC4\x3E", 6}}) {
    PatientFileTick read;
    EXPECT_TRUE(read_log(view(unknown + known), read));
    EXPECT_EQ(read.tick.state, SiteState::Engaged);
    EXPECT_FALSE(read_log(view(unknown.substr(0, unknown.size() - 1)), read));
  }
  PatientFileTick read;
  EXPECT_FALSE(read_log(view(std::string{"\xC4\x3E", 2}), read));  // an end without a begin
  EXPECT_FALSE(read_log(view(std::string{"\x00\x01", 2}), read));  // field 0
}

TEST(LogBytesTest, RefusesATagInMoreBytesThanItNeeds) {
  PatientFileTick read;
  EXPECT_TRUE(read_log(view(std::string{"\x08\x02", 2}), read));
  EXPECT_FALSE(read_log(view(std::string{"\x88\x00\x02", 3}), read));
}

TEST(LogBytesTest, WhatComesLastCountsAndAPayloadReplacesAnother) {
  PatientFileTick read;
  EXPECT_TRUE(read_log(view(std::string{"\x08\x01\x08\x02", 4}), read));
  EXPECT_EQ(read.tick.state, SiteState::Engaged);
  // wave { energy }, then tdpa {}
  EXPECT_TRUE(read_log(view(std::string{"\x6A\x00\x72\x00", 4}), read));
  EXPECT_TRUE(std::holds_alternative<TdpaPayload>(read.tick.sent.payload));
}

TEST(LogBytesTest, AClockThatNamesNoOffsetIsNone) {
  LinkStatus status;
  EXPECT_TRUE(read_log(view(std::string{"\xB8\x01\x05", 3}), status));  // uncertainty alone
  EXPECT_FALSE(status.health.peer_clock);
  EXPECT_TRUE(read_log(view(std::string{"\xA8\x01\x00", 3}), status));  // offset 0
  ASSERT_TRUE(status.health.peer_clock);
  EXPECT_EQ(status.health.peer_clock->offset, Duration{0});
}

TEST(LogBytesTest, RefusesTextThatIsNoUtf8AndCodesThatDoNotFit) {
  Event event;
  EXPECT_TRUE(read_log(view("\x1A\x02\xC3\xA4"), event));
  EXPECT_FALSE(read_log(view("\x1A\x01\xC3"), event));
  EXPECT_TRUE(read_log(view("\x10\xFF\xFF\x03"), event));
  EXPECT_FALSE(read_log(view("\x10\x80\x80\x04"), event));
}

}  // namespace
}  // namespace palp::message
