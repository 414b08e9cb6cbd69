#include "monitor/server.h"

#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/io/realtime/steady_clock.h"
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

/// A socket at ::1 on a free port, as another user's program has it. 0: there is no IPv6.
class AtIpv6 {
 public:
  AtIpv6() : socket_{::socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in6 at{};
    at.sin6_family = AF_INET6;
    at.sin6_addr = IN6ADDR_LOOPBACK_INIT;
    socklen_t size = sizeof at;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): how sockets take addresses
    auto* const address = reinterpret_cast<sockaddr*>(&at);
    if (::bind(socket_, address, size) == 0 && ::listen(socket_, 1) == 0 &&
        ::getsockname(socket_, address, &size) == 0) {
      port_ = ntohs(at.sin6_port);
    }
  }
  AtIpv6(const AtIpv6&) = delete;
  AtIpv6& operator=(const AtIpv6&) = delete;
  ~AtIpv6() { ::close(socket_); }
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

 private:
  int socket_;
  std::uint16_t port_{};
};

TEST(ServerTest, APortThatAnotherHasAtTheOtherAddressIsInUse) {
  const AtIpv6 other;
  if (other.port() == 0) GTEST_SKIP() << "no IPv6 here";
  Feed feed{link::Role::Surgeon, {}, std::chrono::milliseconds{1}};
  try {
    const Server server{{.desk = {}, .tokens = {}, .port = other.port(), .origins = {}}, {}, feed};
    FAIL() << "http://localhost would be the other's page";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(),
                StartsWith("the monitor cannot listen on [::1]:" + std::to_string(other.port()) +
                           ": Address already in use"));
  }
}

/// So that the client is the pilot and may publish where its pointer is.
void take_pointer(RawClient& client) {
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(client.message());
  (void)client.say_frame(
      1, R"({"op":"advertise","channels":[{"id":9,"topic":"monitor/pointer","encoding":"json"}]})");
  ASSERT_TRUE(client.say_frame(2, "\x02\x05\0\0\0\x09\0\0\0\x04\0\0\0json{}"s));
  const auto answer = client.message();
  ASSERT_TRUE(answer);
  ASSERT_THAT(answer->body, HasSubstr("\"ok\":true"));
}
void hold(RawClient& client, int press) {
  (void)client.say_frame(2,
                         "\x01\x09\0\0\0{\"press\":"s + std::to_string(press) +
                             R"(,"held":true,"into_m":0,"x_m":0,"y_m":0})");
}

TEST(ServerTest, AHandIsLetGoOfWhereAnswersDoNotComeThoughMessagesDo) {
  constexpr Duration kMessageEvery = std::chrono::milliseconds{16};
  ServerRig rig;
  RawClient client = rig.client(rig.control);
  take_pointer(client);
  const io::SteadyClock clock;
  // Pings are answered until the hand is held; a busy machine may be late a few times.
  int press = 0;
  for (int i = 0; i < 100 && !rig.pointer.get().held; ++i) {
    const auto ping = client.frame();
    ASSERT_TRUE(ping);
    if (ping->opcode != 9) continue;
    (void)client.say_frame(10, ping->body);
    hold(client, ++press);
    clock.pass(kMessageEvery);
  }
  ASSERT_TRUE(rig.pointer.get().held);
  for (int i = 0; i < 300 && rig.pointer.get().held; ++i) {
    hold(client, press);
    clock.pass(kMessageEvery);
  }
  EXPECT_FALSE(rig.pointer.get().held);
  std::string said;
  for (int i = 0; i < 10 && said.find("let go of") == said.npos; ++i) {
    const auto frame = client.frame();
    if (!frame) break;
    said = frame->body;
  }
  EXPECT_THAT(said, HasSubstr("the hand was let go of: this page answers too late to hold it"));
}

}  // namespace
}  // namespace palp::monitor
