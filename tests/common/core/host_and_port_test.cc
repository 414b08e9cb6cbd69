#include "common/core/host_and_port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

using testing::HasSubstr;

std::string refusal(std::string_view text, std::uint16_t port_min = 0) {
  const auto place = parse_host_and_port(text, port_min);
  return place ? "accepted " + place->to_string() : place.error().text;
}

TEST(HostAndPortTest, ReadsNamesAndNumericAddresses) {
  EXPECT_EQ(parse_host_and_port("192.0.2.7:9000"),
            (HostAndPort{.host = "192.0.2.7", .port = 9000}));
  EXPECT_EQ(parse_host_and_port("or-3.example.org:1"),
            (HostAndPort{.host = "or-3.example.org", .port = 1}));
  EXPECT_EQ(parse_host_and_port("[fe80::1%eth0]:65535"),
            (HostAndPort{.host = "fe80::1%eth0", .port = 65535}));
}

TEST(HostAndPortTest, RefusesWithASentenceThatNamesTheFault) {
  EXPECT_EQ(refusal("127.0.0.1"),
            "address \"127.0.0.1\" has no port; expected HOST:PORT, for example 127.0.0.1:9000");
  EXPECT_THAT(refusal("127.0.0.1:65536"), HasSubstr("the port \"65536\"; expected 0 to 65535"));
  EXPECT_THAT(refusal("127.0.0.1:0", 1), HasSubstr("the port \"0\"; expected 1 to 65535"));
  EXPECT_THAT(refusal("127.0.0.1:"), HasSubstr("the port \"\""));
  EXPECT_THAT(refusal("127.0.0.1:-1"), HasSubstr("the port \"-1\""));
  EXPECT_THAT(refusal("127.0.0.1: 90"), HasSubstr("the port \" 90\""));
  EXPECT_THAT(refusal("127.0.0.1:90x"), HasSubstr("the port \"90x\""));
  EXPECT_THAT(refusal(":9000"), HasSubstr("has no host"));
  EXPECT_THAT(refusal("::1:9000"), HasSubstr("needs brackets"));
  EXPECT_THAT(refusal("[127.0.0.1]:9000"), HasSubstr("no IPv6 address"));
  EXPECT_THAT(refusal("two words:9000"), HasSubstr("the host \"two words\""));
  EXPECT_THAT(refusal(std::string_view{"127.0.0.1\0x:9000", 16}), HasSubstr("the host"));
}

RC_GTEST_PROP(HostAndPortTest, GarbageReadsBackOrGetsOneSentence, (const std::string& text)) {
  const auto place = parse_host_and_port(text + ":1");
  if (place) {
    RC_ASSERT(parse_host_and_port(place->to_string()).value() == *place);
  } else {
    RC_ASSERT(!place.error().text.empty());
    RC_ASSERT(place.error().text.find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace palp
