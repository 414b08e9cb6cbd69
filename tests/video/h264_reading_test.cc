#include "video/h264_reading.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::video {
namespace {

RC_GTEST_PROP(H264ReadingTest, AnyBytesAreReadOrRefused, (const std::vector<std::uint8_t>& any)) {
  H264Reading reading;
  Bytes bytes{std::byte{0}, std::byte{0}, std::byte{1}, std::byte{0x67}};
  for (const std::uint8_t byte : any) bytes.push_back(std::byte{byte});
  (void)reading.read(bytes);
  bytes[3] = std::byte{0x65};
  const auto nature = reading.read(bytes);
  if (nature) RC_ASSERT(nature->key);
}

TEST(H264ReadingTest, NoSliceSaysNothing) {
  H264Reading reading;
  EXPECT_FALSE(reading.read({}));
  const Bytes parameters{
      std::byte{0}, std::byte{0}, std::byte{1}, std::byte{0x68}, std::byte{0xce}};
  EXPECT_FALSE(reading.read(parameters));
}

}  // namespace
}  // namespace palp::video
