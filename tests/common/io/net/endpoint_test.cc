#include "common/io/net/endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::io {
namespace {

using testing::HasSubstr;

TEST(EndpointTest, PrintsWhatItWasMadeFrom) {
  EXPECT_EQ(resolve_endpoint("127.0.0.1:9000")->to_string(), "127.0.0.1:9000");
  EXPECT_EQ(resolve_endpoint("[::1]:65535")->to_string(), "[::1]:65535");
  EXPECT_EQ(resolve_endpoint("0.0.0.0:0")->port(), 0);
}

TEST(EndpointTest, AnUnknownHostIsNamed) {
  const auto endpoint = resolve_endpoint("no-such-host.invalid:9000");
  ASSERT_FALSE(endpoint);
  EXPECT_THAT(endpoint.error().text, HasSubstr("cannot find host \"no-such-host.invalid\""));
}

TEST(EndpointTest, EqualMeansSameAddressAndPort) {
  const Endpoint one = *resolve_endpoint("127.0.0.1:9000");
  EXPECT_EQ(one, *resolve_endpoint("127.0.0.1:9000"));
  EXPECT_FALSE(one == *resolve_endpoint("127.0.0.1:9001"));
  EXPECT_FALSE(one == *resolve_endpoint("127.0.0.2:9000"));
  EXPECT_FALSE(one == *resolve_endpoint("[::1]:9000"));
  EXPECT_FALSE(Endpoint{} == Endpoint{});
}

TEST(EndpointTest, AHostIsAnAddressOrAPrefixOfSixtyFourBits) {
  const auto same = [](const char* one, const char* other) {
    return resolve_endpoint(one)->same_host(*resolve_endpoint(other));
  };
  EXPECT_TRUE(same("192.0.2.1:1", "192.0.2.1:2"));
  EXPECT_FALSE(same("192.0.2.1:1", "192.0.2.2:1"));
  EXPECT_TRUE(same("[2001:db8:0:1::1]:1", "[2001:db8:0:1:ffff::2]:1"));
  EXPECT_FALSE(same("[2001:db8:0:1::1]:1", "[2001:db8:0:2::1]:1"));
  EXPECT_FALSE(same("[::1]:1", "127.0.0.1:1"));
  EXPECT_TRUE(same("[::ffff:192.0.2.1]:1", "[::ffff:192.0.2.1]:2"));
  EXPECT_FALSE(same("[::ffff:192.0.2.1]:1", "[::ffff:192.0.2.2]:1"));
  EXPECT_FALSE(Endpoint{}.same_host(Endpoint{}));
}

TEST(EndpointTest, TheWireKnowsOneFormForBothFamilies) {
  const auto bytes = [](const char* text) { return resolve_endpoint(text)->bytes(); };
  EXPECT_EQ(bytes("192.0.2.1:9000"), bytes("[::ffff:192.0.2.1]:9000"));
  const Endpoint::Bytes six = bytes("[2001:db8::102]:258");
  EXPECT_EQ(six[0], std::byte{0x20});
  EXPECT_EQ(six[15], std::byte{2});
  EXPECT_EQ(six[16], std::byte{1});
  EXPECT_EQ(six[17], std::byte{2});
  EXPECT_NE(bytes("192.0.2.1:9000"), bytes("192.0.2.1:9001"));
  EXPECT_NE(bytes("192.0.2.1:9000"), bytes("192.0.2.2:9000"));
  EXPECT_EQ(Endpoint{}.bytes(), Endpoint::Bytes{});
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

TEST(EndpointTest, ACallWithinTheMachineComesFromWithin) {
  EXPECT_EQ(resolve_endpoint("127.0.0.2:9000")->caller().to_string(), "127.0.0.1:0");
  EXPECT_EQ(resolve_endpoint("[::1]:9000")->caller().to_string(), "[::1]:0");
  EXPECT_EQ(resolve_endpoint("192.0.2.1:9000")->caller().to_string(), "0.0.0.0:0");
  EXPECT_EQ(resolve_endpoint("[2001:db8::1]:9000")->caller().to_string(), "[::]:0");
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
