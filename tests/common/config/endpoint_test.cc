#include "common/config/endpoint.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::config {
namespace {

TEST(EndpointTest, ReadsNumericAddressesAndLocalhost) {
  EXPECT_EQ(parse_endpoint("192.0.2.7:9000"), (Endpoint{.address = "192.0.2.7", .port = 9000}));
  EXPECT_EQ(parse_endpoint("localhost:1"), (Endpoint{.address = "127.0.0.1", .port = 1}));
  EXPECT_EQ(parse_endpoint("[::1]:9000"), (Endpoint{.address = "::1", .port = 9000}));
}

TEST(EndpointTest, HoldsPortsBetweenTheirBorders) {
  EXPECT_TRUE(parse_endpoint("127.0.0.1:0"));
  EXPECT_TRUE(parse_endpoint("127.0.0.1:65535"));
  EXPECT_FALSE(parse_endpoint("127.0.0.1:65536"));
  EXPECT_FALSE(parse_endpoint("127.0.0.1:-1"));
  EXPECT_FALSE(parse_endpoint("127.0.0.1:0", 1));
  EXPECT_EQ(parse_endpoint("127.0.0.1:0", 1).error().text,
            "port \"0\" in \"127.0.0.1:0\" is out of range: 1 to 65535");
}

TEST(EndpointTest, RefusesEverythingElse) {
  for (const char* text : {"",
                           ":",
                           "9000",
                           "127.0.0.1",
                           "127.0.0.1:",
                           "127.0.0.1:9000x",
                           "127.0.0.1: 9000",
                           ":9000",
                           "127.0.0:9000",
                           "127.0.0.256:9000",
                           "example.org:9000",
                           "::1:9000",
                           "[127.0.0.1]:9000",
                           "[]:9000",
                           "[::1]9000"}) {
    EXPECT_FALSE(parse_endpoint(text)) << text;
  }
  EXPECT_FALSE(parse_endpoint(std::string_view{"127.0.0.1\0x:9000", 16}));
}

TEST(EndpointTest, TextReadsBack) {
  for (const char* text : {"127.0.0.1:9000", "[::1]:0", "[2001:db8::7]:65535"}) {
    EXPECT_EQ(to_string(*parse_endpoint(text)), text);
  }
}

RC_GTEST_PROP(EndpointTest, GarbageGetsOneSentence, (const std::string& text)) {
  const auto endpoint = parse_endpoint(text);
  RC_ASSERT(endpoint || (!endpoint.error().text.empty() &&
                         endpoint.error().text.find('\n') == std::string::npos));
}

}  // namespace
}  // namespace palp::config
