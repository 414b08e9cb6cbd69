#include "netem/relay/relay.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/netem/model/datagrams.h"
#include "tests/netem/model/impairment_builders.h"

/// Goal: datagrams cross a real relay between real sockets as its channels decide, whatever the
/// peers do. Method: this thread is client, server and, through short calls of serve(), the relay.
/// Every wait has a deadline, ports come from the kernel.
namespace palp::netem {
namespace {

using std::chrono::milliseconds;

class RelayTest : public ::testing::Test {
 protected:
  Relay relay(std::string_view up, std::string_view down = "none") {
    return Relay{{.listen = kAnyPort,
                  .forward = server_.local(),
                  .up = {.impairment = impaired(up)},
                  .down = {.impairment = impaired(down)},
                  .in_flight_max = 1024}};
  }
  /// Lets the relay work until `socket` has heard `count` datagrams or the deadline has passed.
  static Heard serve(Relay& relay, DatagramSocket& socket, std::size_t count) {
    Heard heard;
    const TimePoint until = monotonic_now() + kDeadline;
    while (heard.numbers.size() < count && monotonic_now() < until) {
      relay.serve(milliseconds{1});
      hear(socket, heard);
    }
    return heard;
  }
  DatagramSocket server_{DatagramSocket::bound(kAnyPort)};
};

TEST_F(RelayTest, CarriesDatagramsBothWays) {
  Relay relay = this->relay("none");
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  for (std::uint32_t i = 0; i < 50; ++i) client.send(saying(i), std::nullopt);
  const Heard up = serve(relay, server_, 50);
  ASSERT_EQ(up.numbers.size(), 50U);
  EXPECT_TRUE(std::is_sorted(up.numbers.begin(), up.numbers.end()));
  for (std::uint32_t i = 0; i < 50; ++i) server_.send(saying(100 + i), up.from);
  const Heard down = serve(relay, client, 50);
  ASSERT_EQ(down.numbers.size(), 50U);
  EXPECT_EQ(down.numbers.front(), 100U);
  EXPECT_EQ(relay.traffic(Direction::Up).forwarded, 50U);
  EXPECT_EQ(relay.traffic(Direction::Down).forwarded, 50U);
}

TEST_F(RelayTest, TellsVideoFromForceByAPortOfItsOwn) {
  Relay relay = this->relay("delay 5ms", "delay 5ms");
  DatagramSocket force = DatagramSocket::connected(relay.listening_on());
  DatagramSocket video = DatagramSocket::connected(relay.listening_on());
  auto picture = saying(0);
  picture[0] = std::byte{0x85};
  force.send(saying(1), std::nullopt);
  const Heard from_force = serve(relay, server_, 1);
  video.send(picture, std::nullopt);
  const Heard from_video = serve(relay, server_, 1);
  ASSERT_EQ(from_video.numbers.size(), 1U);
  EXPECT_FALSE(from_force.from == from_video.from);
  // Each gets what is meant for it, in whatever order.
  for (int i = 0; i < 3; ++i) {
    server_.send(saying(2), from_force.from);
    server_.send(picture, from_video.from);
  }
  EXPECT_EQ(serve(relay, force, 3).numbers, (std::vector<std::uint32_t>{2, 2, 2}));
  EXPECT_EQ(serve(relay, video, 3).numbers, (std::vector<std::uint32_t>{0x85, 0x85, 0x85}));
  EXPECT_EQ(relay.client()->port(), force.local().port()) << "video is no other client of force";
}

TEST_F(RelayTest, HoldsEachDatagramForItsDelay) {
  Relay relay = this->relay("delay 30ms");
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  for (std::uint32_t i = 0; i < 5; ++i) client.send(saying(i), std::nullopt);
  EXPECT_EQ(serve(relay, server_, 5).numbers.size(), 5U);
  const RelayTraffic traffic = relay.traffic(Direction::Up);
  // Sent no more than its send call's cost (20 us at most) before its time. How late is the
  // machine's affair, and reported.
  EXPECT_GE(traffic.delay.min(), milliseconds{30} - std::chrono::microseconds{20});
  EXPECT_EQ(relay.channel(Direction::Up).achieved_delay().max(), milliseconds{30});
}

TEST_F(RelayTest, LosesAndDuplicatesAsTheChannelDecides) {
  Relay relay = this->relay("loss 30% duplicate 20%");
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  Channel twin{impaired("loss 30% duplicate 20%"), RelayConfig{}.seed, Direction::Up, 1024};
  Heard expected;
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  for (std::uint32_t i = 0; i < 200; ++i) {
    client.send(saying(i), std::nullopt);
    twin.push(saying(i), TimePoint{});
    while (const auto released = twin.pop(buffer, TimePoint{})) {
      expected.numbers.push_back(static_cast<std::uint32_t>(released->index));
    }
  }
  EXPECT_EQ(serve(relay, server_, expected.numbers.size()).numbers, expected.numbers);
  EXPECT_EQ(relay.channel(Direction::Up).counters().lost, twin.counters().lost);
}

TEST_F(RelayTest, ARestartedClientWithANewPortGetsTheReplies) {
  Relay relay = this->relay("none");
  io::Endpoint back;
  {
    DatagramSocket first = DatagramSocket::connected(relay.listening_on());
    first.send(saying(1), std::nullopt);
    back = serve(relay, server_, 1).from;
    EXPECT_EQ(relay.client(), first.local());
  }
  DatagramSocket second = DatagramSocket::connected(relay.listening_on());
  const TimePoint until = monotonic_now() + kDeadline;
  while (relay.client() != second.local() && monotonic_now() < until) {
    second.send(saying(0x80), std::nullopt);  // as a telegram begins
    EXPECT_EQ(serve(relay, server_, 1).from, back) << "the patient sees one peer throughout";
  }
  EXPECT_EQ(relay.client(), second.local());
  server_.send(saying(3), back);
  EXPECT_EQ(serve(relay, second, 1).numbers, std::vector<std::uint32_t>{3});
}

TEST_F(RelayTest, RepliesBeforeAnyClientAreCountedNotSent) {
  Relay relay = this->relay("none");
  server_.send(saying(2), relay.forwarding_from());
  const TimePoint until = monotonic_now() + kDeadline;
  while (relay.traffic(Direction::Down).unsent == 0 && monotonic_now() < until) {
    relay.serve(milliseconds{1});
  }
  EXPECT_EQ(relay.traffic(Direction::Down).unsent, 1U);
  EXPECT_EQ(relay.traffic(Direction::Down).forwarded, 0U);
  EXPECT_EQ(relay.traffic(Direction::Down).socket_errors, 0U);
  EXPECT_FALSE(relay.client());
}

TEST_F(RelayTest, SurvivesAServerThatVanishesAndComesBack) {
  io::Endpoint address;
  {
    const DatagramSocket gone = DatagramSocket::bound(kAnyPort);
    address = gone.local();
  }
  Relay relay{{.listen = kAnyPort, .forward = address, .in_flight_max = 64}};
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  const TimePoint until = monotonic_now() + kDeadline;
  while (relay.traffic(Direction::Up).socket_errors == 0 && monotonic_now() < until) {
    client.send(saying(0), std::nullopt);
    relay.serve(milliseconds{1});
  }
  EXPECT_GT(relay.traffic(Direction::Up).socket_errors, 0U);
  DatagramSocket back = DatagramSocket::bound(address);
  client.send(saying(7), std::nullopt);
  const Heard heard = serve(relay, back, 1);
  ASSERT_FALSE(heard.numbers.empty());
  EXPECT_EQ(heard.numbers.back(), 7U);
}

TEST_F(RelayTest, StopsWhenItsDescriptorBecomesReadable) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  Relay relay{{.listen = kAnyPort,
               .forward = server_.local(),
               .in_flight_max = 64,
               .stop_descriptor = ends[0]}};
  EXPECT_TRUE(relay.serve(milliseconds{1}));
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  EXPECT_FALSE(relay.serve(kDeadline));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(RelayTest, ServiceClassesCrossOnBothFamilies) {
  for (const char* any : {"127.0.0.1:0", "[::1]:0"}) {
    const io::Endpoint local = *io::resolve_endpoint(any);
    DatagramSocket server = DatagramSocket::bound(local);
    Relay relay{{.listen = local, .forward = server.local(), .in_flight_max = 16}};
    DatagramSocket client = DatagramSocket::connected(relay.listening_on());
    const auto datagram = saying(1);
    const OutgoingDatagram marked{.bytes = datagram, .tos = 0xba};
    ASSERT_EQ(client.send({&marked, 1}, nullptr), 1U) << any;
    std::optional<std::uint8_t> tos;
    for (const TimePoint until = monotonic_now() + kDeadline; !tos && monotonic_now() < until;) {
      relay.serve(milliseconds{1});
      const auto heard = server.receive();
      if (!heard.empty()) tos = heard.front().tos;
    }
    EXPECT_EQ(tos, std::optional<std::uint8_t>{0xba}) << any;
  }
}

TEST_F(RelayTest, AnAddressInUseIsAnException) {
  EXPECT_THROW(DatagramSocket::bound(server_.local()), std::system_error);
}

TEST(DatagramSocketTest, AnEarlierRefusalDoesNotCostTheDatagramAtHand) {
  io::Endpoint address;
  {
    const DatagramSocket gone = DatagramSocket::bound(kAnyPort);
    address = gone.local();
  }
  DatagramSocket socket = DatagramSocket::connected(address);
  EXPECT_TRUE(socket.send(saying(1), std::nullopt));
  // On loopback the refusal is there before the call returns; the next call hears of it.
  EXPECT_TRUE(socket.send(saying(2), std::nullopt));
  EXPECT_EQ(socket.errors(), 1U);
}

TEST(DatagramSocketTest, AnotherPortDoesNotForgetTheErrors) {
  DatagramSocket peer = DatagramSocket::bound(kAnyPort);
  const io::Endpoint gone = DatagramSocket::bound(kAnyPort).local();
  DatagramSocket socket = DatagramSocket::connected(gone);
  socket.send(saying(1), std::nullopt);
  socket.send(saying(2), std::nullopt);
  const std::uint64_t errors = socket.errors();
  ASSERT_GT(errors, 0U);
  const io::Endpoint before = socket.local();
  socket.reconnect(peer.local());
  EXPECT_FALSE(socket.local() == before);
  EXPECT_EQ(socket.errors(), errors);
  EXPECT_TRUE(socket.send(saying(3), std::nullopt));
  EXPECT_FALSE(peer.receive().empty());
}

}  // namespace
}  // namespace palp::netem
