#include "common/io/endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::io {
namespace {

using testing::HasSubstr;

std::string refusal(std::string_view text) {
  const Result<Endpoint> endpoint = resolve_endpoint(text);
  return endpoint ? "accepted " + endpoint->to_string() : endpoint.error().text;
}

TEST(EndpointTest, PrintsWhatItWasMadeFrom) {
  EXPECT_EQ(resolve_endpoint("127.0.0.1:9000")->to_string(), "127.0.0.1:9000");
  EXPECT_EQ(resolve_endpoint("[::1]:65535")->to_string(), "[::1]:65535");
  EXPECT_EQ(resolve_endpoint("0.0.0.0:0")->port(), 0);
}

TEST(EndpointTest, RefusesWithASentenceThatNamesTheFault) {
  EXPECT_EQ(refusal("127.0.0.1"),
            "address \"127.0.0.1\" has no port; expected HOST:PORT, for example 127.0.0.1:9000");
  EXPECT_THAT(refusal("127.0.0.1:65536"), HasSubstr("the port \"65536\"; expected 0 to 65535"));
  EXPECT_THAT(refusal("127.0.0.1:"), HasSubstr("the port \"\""));
  EXPECT_THAT(refusal("127.0.0.1:-1"), HasSubstr("the port \"-1\""));
  EXPECT_THAT(refusal("127.0.0.1:90x"), HasSubstr("the port \"90x\""));
  EXPECT_THAT(refusal(":9000"), HasSubstr("has no host"));
  EXPECT_THAT(refusal("::1:9000"), HasSubstr("needs brackets"));
  EXPECT_THAT(refusal("no-such-host.invalid:9000"),
              HasSubstr("cannot find host \"no-such-host.invalid\""));
}

TEST(EndpointTest, EqualMeansSameAddressAndPort) {
  const Endpoint one = *resolve_endpoint("127.0.0.1:9000");
  EXPECT_EQ(one, *resolve_endpoint("127.0.0.1:9000"));
  EXPECT_FALSE(one == *resolve_endpoint("127.0.0.1:9001"));
  EXPECT_FALSE(one == *resolve_endpoint("127.0.0.2:9000"));
  EXPECT_FALSE(one == *resolve_endpoint("[::1]:9000"));
  EXPECT_FALSE(Endpoint{} == Endpoint{});
}

TEST(EndpointTest, LoopbackIsWhatNeverLeavesTheMachine) {
  for (const char* text : {"127.0.0.1:1", "127.255.255.254:1", "[::1]:1"}) {
    EXPECT_TRUE(resolve_endpoint(text)->loopback()) << text;
  }
  for (const char* text :
       {"126.255.255.255:1", "128.0.0.1:1", "0.0.0.0:1", "[::]:1", "[fe80::1]:1"}) {
    EXPECT_FALSE(resolve_endpoint(text)->loopback()) << text;
  }
  EXPECT_FALSE(Endpoint{}.loopback());
}

TEST(EndpointTest, ForeignFamiliesAndShortAddressesAreNone) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  EXPECT_TRUE((Endpoint{&address, sizeof address}).valid());
  EXPECT_FALSE((Endpoint{&address, sizeof address - 1}).valid());
  address.sin_family = AF_UNIX;
  EXPECT_FALSE((Endpoint{&address, sizeof address}).valid());
}

}  // namespace
}  // namespace palp::io
