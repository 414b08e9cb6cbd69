#include "site_program/site_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using testing::HasSubstr;

const settings::ProtectionSettings kInsecure{.insecure = true};
const settings::ProtectionSettings kProven{.identity = "keys/surgeon"};

TEST(SiteAddressTest, WithAnIdentityAnyAddressIsPermitted) {
  for (const std::string text : {"127.0.0.1:9000", "10.0.0.1:9000", "[::]:9000"}) {
    const auto address = site_address("--peer", text, kProven, 1);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->to_string(), text);
  }
}

TEST(SiteAddressTest, IdentityAndPlainDatagramsExcludeEachOther) {
  const auto address =
      site_address("--peer", "127.0.0.1:9000", {.insecure = true, .identity = "keys"}, 1);
  ASSERT_FALSE(address);
  EXPECT_THAT(address.error().reason, HasSubstr("exclude each other"));
}

TEST(SiteAddressTest, LoopbackIsPermittedWhenAskedFor) {
  for (const std::string text : {"127.0.0.1:9000", "127.1.2.3:9000", "[::1]:9000"}) {
    const auto address = site_address("--peer", text, kInsecure, 1);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->to_string(), text);
  }
}

TEST(SiteAddressTest, PlainDatagramsMustBeAskedFor) {
  const auto address = site_address("--peer", "127.0.0.1:9000", {}, 1);
  ASSERT_FALSE(address);
  EXPECT_EQ(address.error().code, config::ExitCode::BadInput);
  EXPECT_THAT(address.error().reason, HasSubstr("--insecure"));
}

TEST(SiteAddressTest, PlainDatagramsNeverLeaveTheMachine) {
  for (const std::string text : {"10.0.0.1:9000", "0.0.0.0:9000", "[::]:9000", "128.0.0.1:9000"}) {
    const auto address = site_address("--listen", text, kInsecure, 0);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().code, config::ExitCode::BadInput);
    EXPECT_THAT(address.error().reason, HasSubstr("--listen " + text + " is not a loopback"));
  }
}

TEST(SiteAddressTest, WhatIsNoAddressIsBadInput) {
  EXPECT_THAT(site_address("--peer", "", kInsecure, 1).error().reason,
              HasSubstr("--peer is missing"));
  EXPECT_THAT(site_address("--peer", "127.0.0.1", kInsecure, 1).error().reason,
              HasSubstr("has no port"));
  EXPECT_THAT(site_address("--peer", "127.0.0.1:0", kInsecure, 1).error().reason,
              HasSubstr("expected 1 to 65535"));
  EXPECT_TRUE(site_address("--listen", "127.0.0.1:0", kInsecure, 0));
}

TEST(SiteAddressTest, AHostThatCannotBeFoundCannotBeReached) {
  const auto address = site_address("--peer", "no-such-host.invalid:9000", kInsecure, 1);
  ASSERT_FALSE(address);
  EXPECT_EQ(address.error().code, config::ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::site_program
