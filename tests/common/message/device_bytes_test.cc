// Goal: a Hello's devices come back as they were told, in one length whatever a site has.
#include "common/message/device_bytes.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/message/readings.h"
#include "proto/shared.pb.h"
#include "tests/common/message/draw.h"
#include "tests/common/message/same.h"

namespace palp::message {
namespace {

std::vector<std::byte> written(const DeviceFacts& facts) {
  std::array<std::byte, kDevicesSizeMax> room{};
  const std::size_t size = write_devices(facts, room);
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
}

/// Numbers may be anything, but a device that is there has axes or a pole.
DeviceFacts some_devices(std::uint64_t seed) {
  auto facts = drawn<Form::Log, DeviceFacts>(seed);
  if (facts.hand) facts.hand->axes = 1 + facts.hand->axes % 6;
  if (facts.stage) facts.stage->axes = 1 + facts.stage->axes % 6;
  if (facts.sensor && facts.sensor->pole == 0) facts.sensor->pole = 1;
  return facts;
}

RC_GTEST_PROP(DeviceBytesTest, DevicesComeBackInBytesOfOneLength, (std::uint64_t seed)) {
  const DeviceFacts facts = some_devices(seed);
  const std::vector<std::byte> bytes = written(facts);
  RC_ASSERT(bytes.size() == written({}).size());
  DeviceFacts again{};
  RC_ASSERT(read_devices(bytes, again));
  RC_ASSERT(same(again, facts));
}

RC_GTEST_PROP(DeviceBytesTest, ProtobufReadsEachNumberWhateverASiteHas, (std::uint64_t seed)) {
  const std::vector<std::byte> bytes = written(some_devices(seed));
  shared::Devices theirs;
  RC_ASSERT(theirs.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
  std::vector<const google::protobuf::FieldDescriptor*> there;
  theirs.GetReflection()->ListFields(theirs, &there);
  RC_ASSERT(static_cast<int>(there.size()) == shared::Devices::descriptor()->field_count());
}

TEST(DeviceBytesTest, WhatANewerSiteAddsIsSkippedAndWhatIsNoMessageRefused) {
  std::vector<std::byte> bytes = written({.hand = HandFacts{}, .stage = {}, .sensor = {}});
  for (const int byte : {0xF8, 0x01, 0x07}) bytes.push_back(static_cast<std::byte>(byte));
  DeviceFacts facts{};
  EXPECT_TRUE(read_devices(bytes, facts));
  EXPECT_TRUE(facts.hand);
  bytes.pop_back();
  EXPECT_FALSE(read_devices(bytes, facts));
}

}  // namespace
}  // namespace palp::message
