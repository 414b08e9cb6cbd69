#include "monitor/server.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/monitor/server_rig.h"

namespace palp::monitor {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using namespace std::string_literals;

SiteTick tick_at(int second) {
  SiteTick tick;
  tick.at = TimePoint{std::chrono::seconds{second}};
  tick.force = 0.25;
  return tick;
}

TEST(ServerTest, ServesThePageUnderAStrictPolicy) {
  const ServerRig rig;
  const std::string page = rig.get("/");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'"));
  EXPECT_THAT(page, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(page, HasSubstr("src=\"/page.js\""));
  EXPECT_THAT(rig.get("/page.js"), HasSubstr("Content-Type: text/javascript"));
  EXPECT_THAT(rig.get("/nothing"), StartsWith("HTTP/1.1 404"));
}

TEST(ServerTest, AClientIsGreetedAndHearsWhatItAskedFor) {
  ServerRig rig;
  RawClient client{rig.port()};
  ASSERT_TRUE(client.say(upgrade_request(rig.port(), rig.view)));
  const std::string head = client.head();
  EXPECT_THAT(head, StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(head, HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1"));
  EXPECT_THAT(client.message()->body, HasSubstr("\"serverInfo\""));
  EXPECT_THAT(client.message()->body, HasSubstr("\"advertise\""));
  EXPECT_TRUE(
      client.say_frame(1, R"({"op":"subscribe","subscriptions":[{"id":3,"channelId":100}]})"));
  rig.feed.take(tick_at(1));
  rig.feed.tell(false);
  // Told once for each new stamp, and perhaps before the subscription came.
  std::optional<RawClient::Frame> heard;
  for (int i = 2; !heard && i < 100; ++i) {
    rig.feed.take(tick_at(i));
    rig.feed.tell(false);
    heard = client.message();
  }
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->opcode, 2);
  EXPECT_EQ(heard->body.substr(0, 5), "\x01\x03\0\0\0"s);
  EXPECT_THAT(heard->body, HasSubstr("\"force_n\":0.25"));
}

TEST(ServerTest, AStopIsAnsweredAndObeyed) {
  ServerRig rig;
  RawClient client = rig.client(rig.control);
  for (int i = 0; i < 3; ++i) (void)client.message();
  ASSERT_TRUE(client.say_frame(2, "\x02\x02\0\0\0\x09\0\0\0\x04\0\0\0json{}"s));
  const auto answer = client.message();
  ASSERT_TRUE(answer);
  EXPECT_THAT(answer->body, HasSubstr("\"ok\":true"));
  EXPECT_EQ(rig.stops.get(), 1U);
}

TEST(ServerTest, APortInUseIsOneSentence) {
  const ServerRig rig;
  Feed feed{link::Role::Surgeon, {}, std::chrono::milliseconds{1}};
  try {
    const Server second{{.desk = {}, .tokens = {}, .port = rig.port(), .origins = {}}, {}, feed};
    FAIL() << "it took a port that another has";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(),
                StartsWith("the monitor cannot listen on 127.0.0.1:" + std::to_string(rig.port()) +
                           ": Address already in use"));
  }
}

}  // namespace
}  // namespace palp::monitor
