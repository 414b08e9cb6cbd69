#include "common/message/wire_format.h"

#include <vector>

#include <google/protobuf/wire_format_lite.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/message/text_encoding.h"

namespace palp::message {
namespace {

std::span<const std::byte> view(const std::string& bytes) {
  return std::as_bytes(std::span{bytes});
}

RC_GTEST_PROP(WireFormatTest, VarintsComeBack, (std::uint64_t value)) {
  std::array<std::byte, kVarintSizeMax> room{};
  WireWriter writer{room};
  writer.put_varint(value);
  WireReader reader{std::span{room}.first(writer.size())};
  std::uint64_t read = 0;
  RC_ASSERT(reader.take_varint(read));
  RC_ASSERT(read == value);
  RC_ASSERT(reader.empty());
}

TEST(WireFormatTest, PartsTakeOneByteForTheirSizeAndAbove127Two) {
  for (const std::size_t size : {0U, 1U, 127U, 128U, 129U, 300U, 16383U}) {
    std::vector<std::byte> room(size + 4);
    WireWriter writer{room};
    writer.put_tag<wire_tag(16, WireType::Part)>();
    std::byte* begin = writer.begin_part();
    for (std::size_t i = 0; i < size; ++i) writer.put_byte(static_cast<std::uint8_t>(i));
    writer.end_part(begin);
    EXPECT_EQ(writer.size(), 2 + size_of_size(size) + size);
    WireReader reader{std::span{room}.first(writer.size())};
    ASSERT_TRUE(reader.skip<wire_tag(16, WireType::Part)>());
    std::span<const std::byte> part;
    ASSERT_TRUE(reader.take_bytes(part));
    ASSERT_EQ(part.size(), size);
    EXPECT_TRUE(reader.empty());
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(part[i], static_cast<std::byte>(i & 0xFFU));
  }
}

TEST(WireFormatTest, GroupsNestAndEndByTheirOwnNumber) {
  const auto skipped = [](const std::string& bytes) {
    WireReader reader{view(bytes)};
    return reader.skip_field() && reader.empty();
  };
  EXPECT_TRUE(skipped({"\x0B\x13\x18\x01\x14\x0C", 6}));
  EXPECT_FALSE(skipped({"\x0B\x13\x18\x01\x0C\x14", 6}));
  EXPECT_FALSE(skipped({"\x0B\x13\x14", 3}));
  EXPECT_FALSE(skipped(std::string(200, '\x0B')));
}

RC_GTEST_PROP(TextEncodingTest, IsUtf8WhereProtobufSaysSo, (const std::vector<std::uint8_t>& any)) {
  const std::string text{any.begin(), any.end()};
  using google::protobuf::internal::WireFormatLite;
  RC_ASSERT(is_utf8(text) ==
            WireFormatLite::VerifyUtf8String(
                text.data(), static_cast<int>(text.size()), WireFormatLite::PARSE, "text"));
}

TEST(TextEncodingTest, KnowsTheEdgesOfUtf8) {
  for (const char* good :
       {"", "a", "\xC2\x80", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(is_utf8(good)) << good;
  }
  for (const char* bad : {"\x80",
                          "\xC1\xBF",
                          "\xE0\x9F\xBF",
                          "\xED\xA0\x80",
                          "\xF4\x90\x80\x80",
                          "\xF8\x88\x80\x80\x80",
                          "\xC2",
                          "\xE2\x82",
                          "\xF0\x9F\x98"}) {
    EXPECT_FALSE(is_utf8(bad)) << bad;
  }
}

}  // namespace
}  // namespace palp::message
