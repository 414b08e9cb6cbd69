#include "common/link/codec_control.h"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/message/limits.h"
#include "proto/link.pb.h"

namespace palp::link {
namespace {

std::span<const std::byte> view(const std::string& bytes) {
  return std::as_bytes(std::span{bytes});
}

Hello some_hello() {
  return {.protocol_version = 3,
          .role = Role::Patient,
          .session_id = 0x1122334455667788ULL,
          .peer_session_id = 42,
          .connection_id = 0xDEADBEEF,
          .settings_hash = 99,
          .coupling = "direct",
          .git = "0123abc",
          .devices = {.hand = {},
                      .stage = StageFacts{3, -0.1, 0.2, 0.3, 0.4, 5, 600, 0.07, true},
                      .sensor = ForceSensorFacts{8, 0.09, 10, 0.011, 1200, 0.013, 0.0014}}};
}

TEST(CodecControlTest, ThePageOfTheWireNamesThisVersionAndItsSizes) {
  std::ifstream in{PALP_TREE "/proto/WIRE.md"};
  const std::string page{std::istreambuf_iterator<char>{in}, {}};
  const std::string version = std::to_string(kProtocolVersion);
  EXPECT_THAT(page, testing::HasSubstr("`protocol_version` in `Hello` is " + version + "."));
  EXPECT_THAT(page, testing::HasSubstr("`palp/" + version + "`"));
  std::string telegram = std::to_string(message::kTelegramSizeMax);
  if (telegram.size() > 3) telegram.insert(telegram.size() - 3, ",");
  EXPECT_THAT(page,
              testing::HasSubstr("| telegram / control message | " + telegram + " / " +
                                 std::to_string(kControlSizeMax) + " bytes |"));
}

TEST(CodecControlTest, HelloComesBack) {
  const Hello sent = some_hello();
  const auto received = decode_hello(encode(sent).view());
  ASSERT_TRUE(received);
  EXPECT_EQ(received->protocol_version, sent.protocol_version);
  EXPECT_EQ(received->role, sent.role);
  EXPECT_EQ(received->session_id, sent.session_id);
  EXPECT_EQ(received->peer_session_id, sent.peer_session_id);
  EXPECT_EQ(received->connection_id, sent.connection_id);
  EXPECT_EQ(received->settings_hash, sent.settings_hash);
  EXPECT_EQ(received->coupling, sent.coupling);
  EXPECT_EQ(received->git, sent.git);
  EXPECT_FALSE(received->devices.hand);
  ASSERT_TRUE(received->devices.stage);
  EXPECT_EQ(received->devices.stage->axes, 3U);
  EXPECT_EQ(received->devices.stage->travel_min, -0.1);
  EXPECT_EQ(received->devices.stage->travel_max, 0.2);
  EXPECT_EQ(received->devices.stage->travel_side, 0.3);
  EXPECT_EQ(received->devices.stage->speed, 0.4);
  EXPECT_EQ(received->devices.stage->acceleration, 5);
  EXPECT_EQ(received->devices.stage->rate, 600);
  EXPECT_EQ(received->devices.stage->lag, 0.07);
  EXPECT_TRUE(received->devices.stage->drags);
  ASSERT_TRUE(received->devices.sensor);
  EXPECT_EQ(received->devices.sensor->pole, 8);
  EXPECT_EQ(received->devices.sensor->step, 0.09);
  EXPECT_EQ(received->devices.sensor->range, 10);
  EXPECT_EQ(received->devices.sensor->noise, 0.011);
  EXPECT_EQ(received->devices.sensor->rate, 1200);
  EXPECT_EQ(received->devices.sensor->lag, 0.013);
}

TEST(CodecControlTest, HelloOfAHandComesBack) {
  Hello sent = some_hello();
  sent.devices = {.hand = HandFacts{3, 4, 0.5, 600, 0.02}, .stage = {}, .sensor = {}};
  const auto received = decode_hello(encode(sent).view());
  ASSERT_TRUE(received);
  ASSERT_TRUE(received->devices.hand);
  EXPECT_EQ(received->devices.hand->axes, 3U);
  EXPECT_EQ(received->devices.hand->force_peak, 4);
  EXPECT_EQ(received->devices.hand->force_continuous, 0.5);
  EXPECT_EQ(received->devices.hand->rate, 600);
  EXPECT_EQ(received->devices.hand->lag, 0.02);
  EXPECT_FALSE(received->devices.stage);
  EXPECT_FALSE(received->devices.sensor);
}

TEST(CodecControlTest, AllHellosAreOfOneLengthWhateverDevicesTheyTellOf) {
  Hello hello = some_hello();
  const std::size_t size = encode(hello).size;
  hello.devices = {};
  EXPECT_EQ(encode(hello).size, size);
  hello.devices.hand = HandFacts{};
  EXPECT_EQ(encode(hello).size, size);
}

TEST(CodecControlTest, ByeComesBack) {
  const auto received = decode_bye(encode(Bye{7, 8, ByeReason::Busy, "busy"}).view());
  ASSERT_TRUE(received);
  EXPECT_EQ(received->session_id, 7U);
  EXPECT_EQ(received->peer_session_id, 8U);
  EXPECT_EQ(received->reason, ByeReason::Busy);
  EXPECT_EQ(received->text, "busy");
}

TEST(CodecControlTest, LongTextIsCutAndStaysShort) {
  Hello hello = some_hello();
  hello.coupling.assign(1000, 'x');
  hello.git.assign(1000, 'y');
  EXPECT_EQ(decode_hello(encode(hello).view())->coupling.size(), kNameSizeMax);
  const Bye bye{1, 2, ByeReason::Leaving, std::string(1000, 'z')};
  EXPECT_EQ(decode_bye(encode(bye).view())->text.size(), kTextSizeMax);
}

TEST(CodecControlTest, TextComesOutPrintable) {
  wire::Bye message;
  message.set_text("a\x1b[31mb\n\xc3\xa4");
  EXPECT_EQ(decode_bye(view(message.SerializeAsString()))->text, "a?[31mb???");
}

TEST(CodecControlTest, HelloOfANewerVersionIsStillRead) {
  const ControlBytes bytes = encode(some_hello());
  std::string longer{reinterpret_cast<const char*>(bytes.bytes.data()), bytes.size};
  longer += std::string{"\x78\x01", 2};  // a field 15 that we do not know
  EXPECT_TRUE(decode_hello(view(longer)));
}

TEST(CodecControlTest, RefusesWhatBreaksTheLimits) {
  wire::Hello hello;
  hello.set_session_id(1);
  EXPECT_FALSE(decode_hello(view(hello.SerializeAsString())));  // says no role
  hello.set_role(wire::PATIENT);
  EXPECT_TRUE(decode_hello(view(hello.SerializeAsString())));
  hello.set_role(static_cast<wire::Role>(3));
  EXPECT_FALSE(decode_hello(view(hello.SerializeAsString())));
  hello.set_role(wire::SURGEON);
  hello.set_coupling(std::string(kNameSizeMax + 1, 'x'));
  EXPECT_FALSE(decode_hello(view(hello.SerializeAsString())));
  hello.clear_coupling();
  hello.set_session_id(0);
  EXPECT_FALSE(decode_hello(view(hello.SerializeAsString())));

  wire::Bye bye;
  bye.set_reason(static_cast<wire::Bye::Reason>(3));
  EXPECT_FALSE(decode_bye(view(bye.SerializeAsString())));
  bye.set_reason(static_cast<wire::Bye::Reason>(-1));
  EXPECT_FALSE(decode_bye(view(bye.SerializeAsString())));
  bye.clear_reason();
  bye.set_text(std::string(kTextSizeMax + 1, 'x'));
  EXPECT_FALSE(decode_bye(view(bye.SerializeAsString())));
}

RC_GTEST_PROP(CodecControlTest, SurvivesRandomBytes, (const std::vector<std::uint8_t>& junk)) {
  const auto bytes = std::as_bytes(std::span{junk});
  if (const auto hello = decode_hello(bytes)) RC_ASSERT(decode_hello(encode(*hello).view()));
  if (const auto bye = decode_bye(bytes)) RC_ASSERT(decode_bye(encode(*bye).view()));
}

}  // namespace
}  // namespace palp::link
