#include <deque>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"
#include "tests/monitor/server_rig.h"

// Goal: whoever is no page of this run, by its own browser or on this machine, gets nothing.
// Method: one test for each way in, over real sockets; after each the rightful client is served.
namespace palp::monitor {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using namespace std::string_literals;

/// What the site answers to a request for the live protocol.
std::string asked(const ServerRig& rig,
                  const std::string& token,
                  const std::string& host = "",
                  const std::string& origin = "") {
  RawClient client{rig.port()};
  (void)client.say(upgrade_request(rig.port(), token, host, origin));
  return client.head();
}

void expect_serves(const ServerRig& rig) {
  EXPECT_THAT(asked(rig, rig.control), StartsWith("HTTP/1.1 101"));
}

TEST(ServerAttackTest, APageFromElsewhereIsRefusedWhateverItKnows) {
  const ServerRig rig;
  for (const char* origin : {"http://attacker.org", "null", "http://localhost:1", "file://"}) {
    EXPECT_THAT(asked(rig, rig.control, "", origin), StartsWith("HTTP/1.1 403")) << origin;
  }
  EXPECT_THAT(rig.get("/", "Origin: http://attacker.org\r\n"), StartsWith("HTTP/1.1 403"));
  const std::string own = "http://127.0.0.1:" + std::to_string(rig.port());
  EXPECT_THAT(asked(rig, rig.control, "", own), StartsWith("HTTP/1.1 101"));
}

TEST(ServerAttackTest, ANameThatWasMadeToPointHereIsRefused) {
  const ServerRig rig;
  const std::string port = ":" + std::to_string(rig.port());
  for (const std::string& host : {"attacker.org" + port, "127.0.0.1.attacker.org" + port}) {
    EXPECT_THAT(asked(rig, rig.control, host, "http://" + host), StartsWith("HTTP/1.1 403"));
  }
  expect_serves(rig);
}

TEST(ServerAttackTest, AGuessedTokenIsRefusedAndSoonNotEvenAnswered) {
  const ServerRig rig;
  for (int i = 0; i < 5; ++i) {
    EXPECT_THAT(asked(rig, std::string(32, 'c')), StartsWith("HTTP/1.1 401"));
  }
  EXPECT_EQ(asked(rig, std::string(32, 'c')), "");
  EXPECT_EQ(asked(rig, ""), "");
  expect_serves(rig);
}

TEST(ServerAttackTest, AGiantMessageEndsItsConnection) {
  const ServerRig rig;
  RawClient client = rig.client(rig.control);
  for (int i = 0; i < 3; ++i) (void)client.message();
  (void)client.say_frame(1, std::string(64 * 1024, 'x'));
  EXPECT_FALSE(client.message());
  // A length of 2^62 that nothing follows.
  RawClient liar = rig.client(rig.control);
  for (int i = 0; i < 3; ++i) (void)liar.message();
  (void)liar.say("\x81\xff\x40\0\0\0\0\0\0\0\0\0\0\0"s);
  EXPECT_FALSE(liar.message());
  expect_serves(rig);
}

TEST(ServerAttackTest, AGiantRequestIsCutShort) {
  const ServerRig rig;
  const RawClient client{rig.port()};
  (void)client.say("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100'000, 'x'));
  EXPECT_EQ(client.rest(), "");
  const RawClient body{rig.port()};
  (void)body.say("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000000\r\n\r\n");
  EXPECT_EQ(body.rest(), "");
  EXPECT_THAT(rig.get("/", "Content-Length: 3\r\n\r\nabc"), StartsWith("HTTP/1.1 200"));
}

TEST(ServerAttackTest, AThousandConnectionsKeepNobodyOut) {
  const ServerRig rig;
  RawClient pilot = rig.client(rig.control);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(pilot.message());
  std::deque<RawClient> crowd;
  for (int i = 0; i < 1000; ++i) {
    crowd.emplace_back(rig.port());
    if (i % 2 == 0) (void)crowd.back().say("GET / HT");
    if (crowd.size() > 500) crowd.pop_front();
  }
  expect_serves(rig);
  ASSERT_TRUE(pilot.say_frame(2, "\x02\x01\0\0\0\x09\0\0\0\x04\0\0\0json{}"s));
  const auto answer = pilot.message();
  ASSERT_TRUE(answer) << "who was there before is still served";
  EXPECT_THAT(answer->body, HasSubstr("\"ok\":true"));
}

TEST(ServerAttackTest, MoreClientsThanThereAreSeatsAreToldSo) {
  const ServerRig rig;
  std::vector<RawClient> seated;
  for (std::size_t i = 0; i < Desk::kClientsMax; ++i) {
    seated.push_back(rig.client(rig.view));
    ASSERT_TRUE(seated.back().message()) << i;
  }
  EXPECT_THAT(asked(rig, rig.control), StartsWith("HTTP/1.1 503"));
}

TEST(ServerAttackTest, GarbageIsAnsweredWithASentenceAndAFloodWithTheEnd) {
  const ServerRig rig;
  RawClient client = rig.client(rig.view);
  for (int i = 0; i < 2; ++i) (void)client.message();
  (void)client.say_frame(1, "garbage");
  EXPECT_THAT(client.message()->body, HasSubstr("no text of the protocol"));
  (void)client.say_frame(2, "\xff\xff");
  EXPECT_THAT(client.message()->body, HasSubstr("no bytes of the protocol"));
  for (int i = 0; i < 2000 && client.say_frame(1, "{}"); ++i) {
  }
  while (client.message()) {
  }
  expect_serves(rig);
}

TEST(ServerAttackTest, WhoAsksAndReadsNothingIsClosed) {
  constexpr int kSubscriptions = 3;
  ServerRig rig;
  // Events that each new subscription is told of.
  for (int i = 0; i < 200; ++i) rig.feed.take(Note{.at = {}, .code = 49, .detail = 1.5 * i});
  RawClient client = rig.client(rig.view);
  std::string ask, forget;
  for (int i = 1; i <= kSubscriptions; ++i) {
    const std::string comma = i > 1 ? "," : "";
    ask += comma + R"({"id":)" + std::to_string(i) + R"(,"channelId":)" +
           std::to_string(static_cast<int>(record::Topic::Event) + 1) + "}";
    forget += comma + std::to_string(i);
  }
  const io::SteadyClock clock;
  bool open = true;
  for (int i = 0; i < 100 && open; ++i) {
    (void)client.say_frame(1, R"({"op":"subscribe","subscriptions":[)" + ask + "]}");
    open = client.say_frame(1, R"({"op":"unsubscribe","subscriptionIds":[)" + forget + "]}");
    clock.pass(std::chrono::milliseconds{50});
  }
  EXPECT_FALSE(open) << "what waits for it grows without end";
  expect_serves(rig);
}

TEST(ServerAttackTest, WhoOnlyLooksCannotStopNorSteer) {
  ServerRig rig;
  RawClient client = rig.client(rig.view);
  for (int i = 0; i < 2; ++i) (void)client.message();
  for (const char service : {'\1', '\2', '\3', '\4', '\5'}) {
    (void)client.say_frame(2, "\x02"s + service + "\0\0\0\x09\0\0\0\x04\0\0\0json{}"s);
    EXPECT_THAT(client.message()->body, HasSubstr("this client may only look"));
  }
  EXPECT_EQ(rig.stops.get(), 0U);
}

}  // namespace
}  // namespace palp::monitor
