// Goal: what rt calls of this room allocates, locks, waits and throws nothing.
// Method: RealtimeGuard around ticks under traffic, with noise, a full inbox and path errors.
#include <gtest/gtest.h>

#include "common/io/net/link_update_desk.h"
#include "common/io/net/udp_socket.h"
#include "common/link/aead_protection.h"
#include "common/link/codec_wire.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/link/some_keys.h"
#include "tests/common/link/whole_open.h"
#include "tests/support/realtime_guard.h"

namespace palp::io {
namespace {

using palp::test::RealtimeGuard;
using test::bytes_of;

TEST(RealtimeSafetyTest, SocketIsCleanUnderTrafficNoiseAndPathErrors) {
  const SteadyClock clock;
  SideInbox inbox;
  test::PlainSocket peer;
  const auto socket =
      *UdpSocket::connect(*resolve_endpoint("127.0.0.1:0"), peer.local(), inbox, {});
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  const auto telegram = bytes_of(0x80, 177);

  RealtimeGuard guard;
  for (int tick = 0; tick < 200; ++tick) {
    {
      const RealtimeGuard::Pause pause;
      if (tick == 150) {
        peer.close();
      } else if (tick < 150) {
        peer.send_to(socket->local(), telegram);
        peer.send_to(socket->local(), bytes_of(0x81, 60));
        peer.send_to(socket->local(), bytes_of(0x80, 1300));
      }
    }
    const TimePoint now = clock.now();
    while (socket->receive(buffer, now)) {
    }
    (void)socket->send(telegram, now);
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  EXPECT_EQ(inbox.counting.received, 450U);
  EXPECT_GT(inbox.counting.dropped, 0U);
  EXPECT_GT(inbox.counting.path_errors, 0U);
}

TEST(RealtimeSafetyTest, DeskIsCleanWhileSessionsComeAndGo) {
  const SteadyClock clock;
  test::PlainSocket peer;
  LinkUpdateDesk desk;
  link::Link link{{}, std::make_unique<link::WireCodec>()};
  const auto offer = [&](std::uint64_t id) {
    const RealtimeGuard::Pause pause;
    desk.destroy_retired();
    EXPECT_TRUE(desk.offer({.transport = *UdpSocket::connect(
                                *resolve_endpoint("127.0.0.1:0"), peer.local(), desk.inbox(), {}),
                            .protection = std::make_unique<link::PlainProtection>(),
                            .send_connection = 1,
                            .receive_connection = 2,
                            .session_id = id}));
  };

  RealtimeGuard guard;
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    if (tick % 10 == 0) {
      offer(1 + tick);
    }
    const TimePoint now = clock.now();
    desk.serve(link, now);
    link.warm_up();
    (void)link.receive(now);
    link.send({}, now);
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  EXPECT_EQ(desk.inbox().counting.sent, 100U);
}

TEST(RealtimeSafetyTest, SealingAndOpeningIsCleanAlsoWhereTagsAreRefusedAndKeysAreReplaced) {
  using link::AeadProtection;
  const link::TrafficKeys first = link::some_keys(1, link::Role::Surgeon, 0).data;
  const link::TrafficKeys second = link::some_keys(2, link::Role::Surgeon, 1).data;
  const auto mirrored = [](link::TrafficKeys keys) {
    std::swap(keys.send, keys.receive);
    return keys;
  };
  AeadProtection here{first, second, AeadProtection::Lead::Peer};
  AeadProtection there{mirrored(first), mirrored(second), AeadProtection::Lead::Own};
  std::array<std::byte, link::kDatagramSizeMax> datagram{};
  std::array<std::byte, link::kDatagramSizeMax> room{};
  const std::array<std::byte, 150> plain{};
  std::uint64_t opened = 0;

  RealtimeGuard guard;
  for (std::uint64_t number = 0; number < 1000; ++number) {
    for (AeadProtection* sender : {&here, &there}) {
      AeadProtection& receiver = sender == &here ? there : here;
      const std::size_t size = sender->seal({.number = number}, plain, datagram);
      opened += link::whole_open(receiver, std::span{datagram}.first(size), room) ? 1U : 0U;
      datagram[20] ^= std::byte{1};
      opened += link::whole_open(receiver, std::span{datagram}.first(size), room) ? 1U : 0U;
      sender->warm_up(plain, room);
    }
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  EXPECT_EQ(opened, 2000U);
}

}  // namespace
}  // namespace palp::io
