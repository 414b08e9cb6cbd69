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

settings::ProtectionSettings meeting(const std::string& through, const std::string& room) {
  settings::ProtectionSettings protection;
  protection.identity = "keys";
  protection.through = through;
  protection.room = room;
  return protection;
}

TEST(MeetingPlaceTest, NeedsBothFlagsAndALongName) {
  const auto none = meeting_place("--peer", "", meeting("", ""));
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, std::nullopt);
  const auto found = meeting_place("--peer", "", meeting("127.0.0.1:9100", "K7Q2-a-long-name"));
  ASSERT_TRUE(found && *found);
  EXPECT_EQ((*found)->relay.port, 9100);
  const auto refused = [](const settings::ProtectionSettings& protection, const std::string& peer) {
    const auto place = meeting_place("--peer", peer, protection);
    return place ? std::string{} : place.error().reason;
  };
  EXPECT_THAT(refused(meeting("127.0.0.1:9100", ""), ""), testing::HasSubstr("needs --room"));
  EXPECT_THAT(refused(meeting("", "K7Q2-a-long-name"), ""), testing::HasSubstr("--through"));
  EXPECT_THAT(refused(meeting("127.0.0.1:9100", "short"), ""), testing::HasSubstr("16 to 64"));
  EXPECT_THAT(refused(meeting("127.0.0.1:9100", "K7Q2-a-long-name"), "127.0.0.1:9"),
              testing::HasSubstr("exclude each other"));
  auto plain = meeting("127.0.0.1:9100", "K7Q2-a-long-name");
  plain.identity.clear();
  plain.insecure = true;
  EXPECT_THAT(refused(plain, ""), testing::HasSubstr("--insecure is refused"));
}

}  // namespace
}  // namespace palp::site_program
