#include "common/site_program/plain_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using testing::HasSubstr;

TEST(PlainAddressTest, LoopbackIsPermittedWhenAskedFor) {
  for (const std::string text : {"127.0.0.1:9000", "127.1.2.3:9000", "[::1]:9000"}) {
    const auto address = plain_address("--peer", text, true, 1);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->to_string(), text);
  }
}

TEST(PlainAddressTest, PlainDatagramsMustBeAskedFor) {
  const auto address = plain_address("--peer", "127.0.0.1:9000", false, 1);
  ASSERT_FALSE(address);
  EXPECT_EQ(address.error().code, config::ExitCode::BadInput);
  EXPECT_THAT(address.error().reason, HasSubstr("--insecure"));
}

TEST(PlainAddressTest, PlainDatagramsNeverLeaveTheMachine) {
  for (const std::string text : {"10.0.0.1:9000", "0.0.0.0:9000", "[::]:9000", "128.0.0.1:9000"}) {
    const auto address = plain_address("--listen", text, true, 0);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().code, config::ExitCode::BadInput);
    EXPECT_THAT(address.error().reason, HasSubstr("--listen " + text + " is not a loopback"));
  }
}

TEST(PlainAddressTest, WhatIsNoAddressIsBadInput) {
  EXPECT_THAT(plain_address("--peer", "", true, 1).error().reason, HasSubstr("--peer is missing"));
  EXPECT_THAT(plain_address("--peer", "127.0.0.1", true, 1).error().reason,
              HasSubstr("has no port"));
  EXPECT_THAT(plain_address("--peer", "127.0.0.1:0", true, 1).error().reason,
              HasSubstr("expected 1 to 65535"));
  EXPECT_TRUE(plain_address("--listen", "127.0.0.1:0", true, 0));
}

TEST(PlainAddressTest, AHostThatCannotBeFoundCannotBeReached) {
  const auto address = plain_address("--peer", "no-such-host.invalid:9000", true, 1);
  ASSERT_FALSE(address);
  EXPECT_EQ(address.error().code, config::ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::site_program
